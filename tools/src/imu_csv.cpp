#include "paloc/tools/imu_csv.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <fstream>

#include "paloc/core/errors.h"
#include "paloc/core/text.h"
#include "paloc/frontends/tum_file.h"

namespace paloc {
namespace {

constexpr std::array<std::string_view, 7> kColumns{"t_s",      "ax_mps2",  "ay_mps2", "az_mps2",
                                                   "wx_radps", "wy_radps", "wz_radps"};

std::vector<std::string_view> splitAtCommas(std::string_view line) {
  std::vector<std::string_view> cells;
  while (true) {
    const std::size_t comma = line.find(',');
    std::string_view cell = line.substr(0, comma);
    const auto begin = cell.find_first_not_of(" \t\r");
    cell = begin == cell.npos ? std::string_view{} : cell.substr(begin);
    cells.push_back(cell.substr(0, cell.find_last_not_of(" \t\r") + 1));
    if (comma == std::string_view::npos) return cells;
    line.remove_prefix(comma + 1);
  }
}

class ImuCsvReader {
 public:
  explicit ImuCsvReader(const std::filesystem::path& file) : name_(file.string()), in_(file) {
    if (!in_) throw IoError(text(name_, ": cannot be opened"));
  }

  ImuCsv read() {
    readHeader();
    while (std::getline(in_, line_)) {
      ++number_;
      if (line_.find_first_not_of(" \t\r") != std::string::npos) readRow();
    }
    if (in_.bad()) throw IoError(text(name_, ": cannot be read"));
    if (result_.samples.empty()) throw IoError(text(name_, ": holds no sample"));
    return std::move(result_);
  }

 private:
  void readHeader() {
    std::getline(in_, line_);
    number_ = 1;
    const auto names = splitAtCommas(line_);
    width_ = names.size();
    for (std::size_t k = 0; k < kColumns.size(); ++k) {
      for (std::size_t i = 0; i < names.size(); ++i) {
        if (names[i] != kColumns[k]) continue;
        if (column_[k] != kMissing) fail(text("column '", kColumns[k], "' stands there twice"));
        column_[k] = i;
      }
      if (column_[k] == kMissing) {
        fail(text("there is no column '", kColumns[k],
                  "'; expected t_s,ax_mps2,ay_mps2,az_mps2,wx_radps,wy_radps,wz_radps"));
      }
    }
    for (std::size_t i = 0; i < names.size(); ++i) {
      if (std::find(column_.begin(), column_.end(), i) != column_.end()) continue;
      result_.other_columns += text(result_.other_columns.empty() ? "" : ", ", names[i]);
    }
  }

  void readRow() {
    const auto cells = splitAtCommas(line_);
    if (cells.size() != width_) fail(text("has ", cells.size(), " values, the header ", width_));
    ImuSample sample;
    if (!parseSeconds(cells[column_[0]], sample.t_ns)) {
      fail(text("'", cells[column_[0]], "' is not a time (column 't_s')"));
    }
    std::array<double, 6> v{};
    bool finite = true;
    for (std::size_t k = 0; k < v.size(); ++k) {
      const std::string_view cell = cells[column_[k + 1]];
      const char* end = cell.data() + cell.size();
      const auto [stop, error] = std::from_chars(cell.data(), end, v[k]);
      if (error != std::errc{} || stop != end) {
        fail(text("'", cell, "' is not a number (column '", kColumns[k + 1], "')"));
      }
      finite = finite && std::isfinite(v[k]);
    }
    sample.acc_body = Vec3(v[0], v[1], v[2]);
    sample.omega_body = Vec3(v[3], v[4], v[5]);
    if (finite) result_.samples.push_back(sample);
    result_.nonfinite += finite ? 0 : 1;
  }

  [[noreturn]] void fail(const std::string& sentence) const {
    throw IoError(text(name_, ": line ", number_, ": ", sentence));
  }

  static constexpr std::size_t kMissing = static_cast<std::size_t>(-1);
  std::string name_;
  std::ifstream in_;
  std::string line_;
  std::uint64_t number_ = 0;
  std::size_t width_ = 0;
  std::array<std::size_t, 7> column_{kMissing, kMissing, kMissing, kMissing,
                                     kMissing, kMissing, kMissing};
  ImuCsv result_;
};

}  // namespace

ImuCsv readImuCsv(const std::filesystem::path& file) { return ImuCsvReader(file).read(); }

}  // namespace paloc

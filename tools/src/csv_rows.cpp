#include "csv_rows.h"

#include <algorithm>
#include <charconv>

#include "paloc/core/errors.h"
#include "paloc/core/text.h"
#include "paloc/frontends/tum_file.h"

namespace paloc {
namespace {

constexpr std::size_t kMissing = static_cast<std::size_t>(-1);

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

std::string joined(const std::vector<std::string>& names) {
  std::string all;
  for (const std::string& name : names) all += (all.empty() ? "" : ",") + name;
  return all;
}

}  // namespace

CsvRows::CsvRows(const std::filesystem::path& file, std::vector<std::string> columns)
    : name_(file.string()),
      in_(file),
      columns_(std::move(columns)),
      places_(columns_.size(), kMissing) {
  if (!in_) throw IoError(paloc::text(name_, ": cannot be opened"));
  readHeader();
}

void CsvRows::readHeader() {
  std::getline(in_, line_);
  number_ = 1;
  const auto names = splitAtCommas(line_);
  width_ = names.size();
  for (std::size_t i = 0; i < names.size(); ++i) {
    const auto wanted = std::find(columns_.begin(), columns_.end(), names[i]);
    if (wanted == columns_.end()) {
      others_.emplace_back(names[i]);
      continue;
    }
    std::size_t& place = places_[static_cast<std::size_t>(wanted - columns_.begin())];
    if (place != kMissing) fail(paloc::text("column '", names[i], "' stands there twice"));
    place = i;
  }
  const auto missing = std::find(places_.begin(), places_.end(), kMissing);
  if (missing == places_.end()) return;
  const std::string& column = columns_[static_cast<std::size_t>(missing - places_.begin())];
  fail(paloc::text("there is no column '", column, "'; expected ", joined(columns_)));
}

bool CsvRows::next() {
  while (std::getline(in_, line_)) {
    ++number_;
    if (line_.find_first_not_of(" \t\r") == std::string::npos) continue;
    cells_ = splitAtCommas(line_);
    if (cells_.size() != width_) {
      fail(paloc::text("has ", cells_.size(), " values, the header ", width_));
    }
    return true;
  }
  if (in_.bad()) throw IoError(paloc::text(name_, ": cannot be read"));
  return false;
}

double CsvRows::number(std::size_t index) const {
  const std::string_view cell = text(index);
  double value = 0;
  const auto [stop, error] = std::from_chars(cell.data(), cell.data() + cell.size(), value);
  if (error != std::errc{} || stop != cell.data() + cell.size()) {
    fail(paloc::text("'", cell, "' is not a number (column '", columns_[index], "')"));
  }
  return value;
}

TimeNs CsvRows::time(std::size_t index) const {
  TimeNs t_ns = 0;
  if (!parseSeconds(text(index), t_ns)) {
    fail(paloc::text("'", text(index), "' is not a time (column '", columns_[index], "')"));
  }
  return t_ns;
}

void CsvRows::fail(const std::string& sentence) const {
  throw IoError(paloc::text(name_, ": line ", number_, ": ", sentence));
}

}  // namespace paloc

#include "paloc/frontends/tum_file.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <string>
#include <string_view>

#include "paloc/core/errors.h"
#include "paloc/core/seconds_text.h"

namespace paloc {
namespace {

constexpr std::string_view kBlanks = " \t\r\v\f";
constexpr std::array<const char*, 8> kFields = {"t", "x", "y", "z", "qx", "qy", "qz", "qw"};
// Files with three decimals have quaternions that are off by a thousandth; more is another layout.
constexpr double kUnitTolerance = 1e-2;

struct Line {
  const std::filesystem::path& file;
  std::size_t number;  ///< from 1
};

[[noreturn]] void fail(const Line& line, const std::string& what) {
  throw IoError(line.file.string() + ":" + std::to_string(line.number) + ": " + what);
}

std::vector<std::string_view> splitFields(std::string_view text) {
  std::vector<std::string_view> fields;
  for (std::size_t begin = text.find_first_not_of(kBlanks); begin != std::string_view::npos;) {
    const std::size_t end = std::min(text.find_first_of(kBlanks, begin), text.size());
    fields.push_back(text.substr(begin, end - begin));
    begin = text.find_first_not_of(kBlanks, end);
  }
  return fields;
}

double parseNumber(const Line& line, std::size_t field, std::string_view text) {
  std::string_view digits = text;
  if (digits.size() > 1 && digits.front() == '+') digits.remove_prefix(1);
  double value = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (error != std::errc() || end != digits.data() + digits.size() || !std::isfinite(value)) {
    fail(line, std::string("field ") + kFields[field] + " is not a finite number: \"" +
                   std::string(text) + "\"");
  }
  return value;
}

StampedPose parseLine(const Line& line, const std::vector<std::string_view>& fields) {
  if (fields.size() != kFields.size()) {
    fail(line, "a TUM line has 8 fields (t x y z qx qy qz qw), this one has " +
                   std::to_string(fields.size()));
  }
  StampedPose result;
  if (!parseSeconds(fields[0], result.t_ns)) {
    fail(line, "field t is not a time in seconds: \"" + std::string(fields[0]) + "\"");
  }
  std::array<double, 8> v{};
  for (std::size_t i = 1; i < v.size(); ++i) v[i] = parseNumber(line, i, fields[i]);
  const Quat q(v[7], v[4], v[5], v[6]);
  if (std::abs(q.norm() - 1) > kUnitTolerance) {
    fail(line, "the quaternion's length is " + std::to_string(q.norm()) + ", not 1");
  }
  result.pose.position = Vec3(v[1], v[2], v[3]);
  result.pose.rotation = q.normalized().toRotationMatrix();
  return result;
}

std::string_view withoutComment(std::string_view text) { return text.substr(0, text.find('#')); }

// The one of the two quaternions of a rotation that is written: w > 0, or else the first
// component that is not zero positive.
Quat canonicalQuaternion(const Mat3& rotation) {
  Quat q(rotation);
  q.normalize();
  for (const double c : {q.w(), q.x(), q.y(), q.z()}) {
    if (c > 0) break;
    if (c < 0) {
      q.coeffs() = -q.coeffs();
      break;
    }
  }
  return q;
}

void appendFixed(std::string& line, double value) {
  std::array<char, 400> buffer{};
  const auto [end, error] = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value,
                                          std::chars_format::fixed, 9);
  std::string_view text(buffer.data(), static_cast<std::size_t>(end - buffer.data()));
  if (text == "-0.000000000") text.remove_prefix(1);  // what is no longer negative has no sign
  line.append(text);
}

}  // namespace

std::vector<StampedPose> readTum(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  if (!in)
    throw IoError("cannot read the trajectory " + file.string() + ": " + std::strerror(errno));
  std::vector<StampedPose> poses;
  std::string text;
  for (std::size_t number = 1; std::getline(in, text); ++number) {
    std::string_view view = text;
    if (number == 1 && view.starts_with("\xEF\xBB\xBF")) view.remove_prefix(3);  // byte order mark
    const auto fields = splitFields(withoutComment(view));
    if (!fields.empty()) poses.push_back(parseLine({file, number}, fields));
  }
  if (in.bad()) throw IoError("the trajectory " + file.string() + " could not be read to its end");
  if (poses.empty()) throw IoError("the trajectory " + file.string() + " holds no pose");
  return poses;
}

std::string tumLine(const StampedPose& pose) {
  const Quat q = canonicalQuaternion(pose.pose.rotation);
  const Vec3& p = pose.pose.position;
  std::string line;
  line.reserve(120);
  line += secondsText(pose.t_ns);
  for (const double value : {p.x(), p.y(), p.z(), q.x(), q.y(), q.z(), q.w()}) {
    line += ' ';
    appendFixed(line, value);
  }
  return line;
}

void writeTum(const std::filesystem::path& file, const std::vector<StampedPose>& poses) {
  std::ofstream out(file, std::ios::binary | std::ios::trunc);
  if (!out) {
    throw IoError(file.string() + ": cannot be written: " + std::strerror(errno));
  }
  for (const StampedPose& pose : poses) out << tumLine(pose) << '\n';
  out.close();
  if (!out) throw IoError(file.string() + ": cannot be written completely (is the disk full?)");
}

}  // namespace paloc

#include "paloc/tools/synth_fault.h"

#include <charconv>
#include <cmath>
#include <cstdio>

#include "paloc/core/errors.h"
#include "paloc/core/text.h"

namespace paloc::synth {
namespace {

struct FaultRow {
  FaultKind kind;
  const char* name;
  std::vector<double> defaults;
  double low, high;  // of each value
  const char* help;
};

constexpr double kLongest = 3600;  // s

const std::vector<FaultRow>& rows() {
  using K = FaultKind;
  static const std::vector<FaultRow> table = {
      {K::kImuInG, "imu-g", {}, 0, 0, "acceleration in g"},
      {K::kGyroInDegrees, "gyro-deg", {}, 0, 0, "angular rate in deg/s"},
      {K::kImuMirrored, "imu-mirrored", {}, 0, 0, "the IMU's y axis reversed: left-handed"},
      {K::kImuSwapped, "imu-swapped", {}, 0, 0, "the IMU's x and y exchanged: left-handed"},
      {K::kImuTurned, "imu-turned", {180}, -180, 180, "the IMU turned about z (deg)"},
      {K::kImuRate, "imu-rate", {20}, 1, 200, "IMU samples a second (Hz)"},
      {K::kImuUneven,
       "imu-uneven",
       {},
       0,
       0,
       "the IMU's samples stamped as they arrive, in bursts"},
      {K::kImuGap, "imu-gap", {5, 6}, 0, kLongest, "no IMU from, to (s)"},
      {K::kLidarGap, "lidar-gap", {5, 6}, 0, kLongest, "no scans from, to (s)"},
      {K::kOdometryGap, "odometry-gap", {5, 6}, 0, kLongest, "no odometry from, to (s)"},
      {K::kGyroSaturation, "gyro-saturation", {0.3}, 1e-3, 100, "the gyroscope's limit (rad/s)"},
      {K::kAccSaturation, "acc-saturation", {10.5}, 1e-3, 1000, "the accelerometer's (m/s2)"},
      {K::kNonFinite, "non-finite", {}, 0, 0, "every 50th IMU sample has a NaN"},
      {K::kDuplicates, "duplicates", {}, 0, 0, "every 20th IMU sample, every 10th scan twice"},
      {K::kRewind, "rewind", {5, 0.5}, 0, kLongest, "at, by: all clocks step back (s)"},
      {K::kClockOffset, "clock-offset", {0.01}, -10, 10, "the IMU's stamps are too late (s)"},
      {K::kScanStampEnd, "scan-stamp-end", {}, 0, 0, "scans have the stamp of their end"},
      {K::kExtrinsicsInverse, "extrinsics-inverted", {}, 0, 0, "T_lidar_body for T_body_lidar"},
      {K::kExtrinsicsYaw, "extrinsics-yaw", {90}, -180, 180, "T_body_lidar turned about z (deg)"},
      {K::kExtrinsicsPitch, "extrinsics-pitch", {10}, -180, 180, "the same about y (deg)"},
      {K::kPointTimesUnit, "point-times-unit", {1e-3}, 1e-9, 40, "point times times this"},
      {K::kPointTimesEqual, "point-times-constant", {}, 0, 0, "all points of a scan at one time"},
      {K::kPointTimesFromEnd,
       "point-times-from-end",
       {},
       0,
       0,
       "stamp and times count from the end"},
  };
  return table;
}

double parseValue(const std::string& fault, std::string_view word, const FaultRow& row) {
  double value = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (error != std::errc{} || end != word.data() + word.size() || !(value >= row.low) ||
      !(value <= row.high)) {
    char range[64];
    std::snprintf(range, sizeof range, "%g to %g", row.low, row.high);
    throw UsageError(text("--fault: '", word, "' in '", fault, "' is not a number from ", range));
  }
  return value;
}

std::vector<double> parseValues(const std::string& fault, std::string_view words,
                                const FaultRow& row) {
  std::vector<double> values;
  for (std::size_t comma = 0; comma != std::string_view::npos;) {
    comma = words.find(',');
    values.push_back(parseValue(fault, words.substr(0, comma), row));
    if (comma != std::string_view::npos) words.remove_prefix(comma + 1);
  }
  return values;
}

bool isSpan(FaultKind kind) {
  return kind == FaultKind::kImuGap || kind == FaultKind::kLidarGap ||
         kind == FaultKind::kOdometryGap;
}

}  // namespace

std::string toString(FaultKind kind) {
  for (const FaultRow& row : rows()) {
    if (row.kind == kind) return row.name;
  }
  return "unknown";
}

std::string faultHelp() {
  std::string help;
  for (const FaultRow& row : rows()) {
    std::string name = row.name;
    for (std::size_t i = 0; i < row.defaults.size(); ++i) {
      char value[32];
      std::snprintf(value, sizeof value, "%s%g", i == 0 ? "=" : ",", row.defaults[i]);
      name += value;
    }
    char line[160];
    std::snprintf(line, sizeof line, "  %-24s %s\n", name.c_str(), row.help);
    help += line;
  }
  return help;
}

Fault parseFault(const std::string& fault) {
  const std::size_t equals = fault.find('=');
  const std::string name = fault.substr(0, equals);
  std::string known;
  for (const FaultRow& row : rows()) {
    known += (known.empty() ? "" : ", ") + std::string(row.name);
    if (name != row.name) continue;
    Fault result{row.kind, row.defaults};
    if (equals == std::string::npos) return result;
    result.values = parseValues(fault, std::string_view(fault).substr(equals + 1), row);
    if (result.values.size() != row.defaults.size()) {
      throw UsageError(text("--fault: '", fault, "' has ", result.values.size(), " values; ", name,
                            " takes ", row.defaults.size()));
    }
    if (isSpan(row.kind) && !(result.values[0] < result.values[1])) {
      throw UsageError(text("--fault: the second time of '", fault, "' must be after the first"));
    }
    return result;
  }
  throw UsageError(text("--fault: there is no fault '", name, "'; there are: ", known));
}

}  // namespace paloc::synth

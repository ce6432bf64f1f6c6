#pragma once

#include <string>
#include <vector>

namespace paloc::synth {

/// What is wrong with how a recording was made; the motion and its truth files stay as they are.
enum class FaultKind {
  kImuInG,             ///< acceleration in g instead of m/s2
  kGyroInDegrees,      ///< angular rate in deg/s instead of rad/s
  kImuMirrored,        ///< the y axis of both sensors points the other way: left-handed
  kImuSwapped,         ///< x and y of both sensors are exchanged: left-handed
  kImuTurned,          ///< values: the IMU is mounted turned by so much about z (deg, default 180)
  kImuRate,            ///< values: only so many samples a second (Hz, default 20)
  kImuUneven,          ///< stamped as they arrive, in bursts of eight
  kImuGap,             ///< values: from, to (s after the first scan's start)
  kLidarGap,           ///< likewise
  kOdometryGap,        ///< likewise
  kGyroSaturation,     ///< values: limit of each axis (rad/s, default 0.3)
  kAccSaturation,      ///< values: limit of each axis (m/s2, default 10.5)
  kNonFinite,          ///< every 50th IMU sample has a value that is not a number
  kDuplicates,         ///< every 20th IMU sample and every 10th scan comes twice
  kRewind,             ///< values: at (s, default 5) all clocks step back by (s, default 0.5)
  kClockOffset,        ///< values: the IMU's stamps are so much too late (s, default 0.01)
  kScanStampEnd,       ///< scans carry the stamp of their end, taken for that of their start
  kExtrinsicsInverse,  ///< T_lidar_body is written where T_body_lidar belongs
  kExtrinsicsYaw,      ///< values: T_body_lidar is turned by so much about z (deg, default 90)
  kExtrinsicsPitch,    ///< values: likewise about y (deg, default 10)
  kPointTimesUnit,     ///< values: point times are multiplied by it (default 0.001)
  kPointTimesEqual,    ///< all points of a scan have the same time
  kPointTimesFromEnd,  ///< stamp of the end, times before it: negative, in an unsigned field
};

struct Fault {
  FaultKind kind = FaultKind::kImuInG;
  std::vector<double> values;  ///< all that the kind has, defaults filled in
};

std::string toString(FaultKind kind);
/// A line for each fault, for the help: name, default values, what it does.
std::string faultHelp();
/// Reads "imu-g" or "imu-gap=10,12". Throws UsageError for an unknown name, a wrong number of
/// values or one that is no number or out of its range.
Fault parseFault(const std::string& text);

}  // namespace paloc::synth

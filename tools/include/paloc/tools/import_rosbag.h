#pragma once

#include "paloc/tools/import_recording.h"
#include "paloc/tools/rosbag_reader.h"

namespace paloc {

struct ImportRosbagSettings {
  std::vector<std::filesystem::path> bags;
  std::string lidar, imu, odometry;   ///< topics; empty: the only one of its kind; "none": none
  std::string time_field;             ///< empty: the usual names
  std::optional<TimeUnit> time_unit;  ///< stated, not decided
  std::optional<TimeReference> time_reference;  ///< likewise
  bool imu_in_g = false;
  bool no_covariance = false;     ///< of the odometry
  bool has_T_body_lidar = false;  ///< scans.T_body_lidar is stated
  ScanConversion scans;
  ImportOutput output;
};

/// Imports ROS 1 bags, read twice: stamps, IMU and odometry at first, then the scans in order of
/// the stamp of their first point. The body is the IMU's frame. Throws UsageError, IoError.
ImportSummary importRosbag(const ImportRosbagSettings& settings,
                           const std::function<void(double)>& progress);

}  // namespace paloc

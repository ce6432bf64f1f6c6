#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "paloc/tools/rosbag_writer.h"

namespace paloc {

struct ExportRosbagSettings {
  std::filesystem::path log, bag;
  RosCloudLayout layout = RosCloudLayout::kOuster;
  bool overwrite = false;
};

struct ExportSummary {
  std::string output;
  std::uint64_t bytes = 0, scans = 0, imu_samples = 0, odometry_poses = 0;
  std::map<std::string, std::string> topics;      ///< topic -> type
  std::map<std::string, std::uint64_t> not_used;  ///< reason -> how many
  std::string damage;                             ///< of the rawlog; empty if it is whole
  bool complete() const { return not_used.empty() && damage.empty(); }
};

/// Writes a rawlog as a ROS 1 bag: each sensor on a topic of its label's name, extrinsics on
/// /tf_static (frame "body" to one of the label's name). Throws UsageError, IoError.
ExportSummary exportRosbag(const ExportRosbagSettings& settings,
                           const std::function<void(double)>& progress);

std::string tableOf(const ExportSummary& summary);
nlohmann::json jsonOf(const ExportSummary& summary);

}  // namespace paloc

#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "paloc/core/imu_sample.h"
#include "paloc/frontends/lidar_frame.h"
#include "paloc/frontends/odometry_reader.h"

namespace paloc {

/// Layouts of a PointCloud2 that public systems read. Both have x, y, z, intensity (float32) and
/// ring (uint16); the time is `t` (uint32, ns after the header's stamp), or `time` (float32, s).
enum class RosCloudLayout { kOuster, kVelodyne };

/// Writes a ROS 1 bag. Everything throws IoError, with the file, when it cannot be written; stamps
/// that ROS cannot hold (before 1970, after 2106) are refused by canHold().
class RosbagWriter {
 public:
  explicit RosbagWriter(const std::filesystem::path& file);
  ~RosbagWriter();
  RosbagWriter(const RosbagWriter&) = delete;
  RosbagWriter& operator=(const RosbagWriter&) = delete;

  static bool canHold(TimeNs t_ns);

  /// The stamp of the header is the scan's, or its end's where it is deskewed to that.
  void writeScan(const std::string& topic, const std::string& frame, const LidarFrame& scan,
                 RosCloudLayout layout);
  void writeImu(const std::string& topic, const std::string& frame, const ImuSample& sample);
  void writeOdometry(const std::string& topic, const std::string& frame,
                     const std::string& child_frame, const OdometryPose& pose);
  /// On /tf_static, latched.
  void writeStaticTransform(TimeNs t_ns, const std::string& frame, const std::string& child_frame,
                            const Pose& T_frame_child);
  void close();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace paloc

#pragma once

#include <optional>
#include <string>
#include <vector>

#include "gyro_track.h"
#include "paloc/frontends/frontend_settings.h"
#include "paloc/frontends/motion_comparison.h"
#include "paloc/frontends/odometry_reader.h"
#include "scan_sequence.h"

namespace paloc {

/// Compares how an IMU turned with how a LiDAR and a recorded odometry turned. Looks at the first
/// five minutes at most, so that neither time nor memory grow with the recording.
class MotionCheck {
 public:
  explicit MotionCheck(const FrontendSettings& settings)
      : settings_(settings), gyro_(settings.max_imu_gap_s) {}

  void addImu(const std::string& label, const ImuSample& sample);
  void addOdometry(const std::string& label, const OdometryPose& pose);
  void addScan(const LidarFrame& frame);

  /// No more comes: one comparison for each sensor that there is besides the IMU.
  std::vector<MotionComparison> compare();

 private:
  bool inTime(TimeNs t_ns);
  void closeSequence();
  std::optional<MotionComparison> compareOdometry() const;
  std::optional<MotionComparison> compareLidar();

  FrontendSettings settings_;
  std::string imu_label_, odometry_label_, lidar_label_;
  std::optional<TimeNs> first_ns_;
  GyroTrack gyro_;

  std::optional<OdometryPose> last_pose_;
  std::vector<TurnStep> odometry_steps_;

  Mat3 R_body_lidar_ = Mat3::Identity();
  double scan_duration_s_ = 0;
  ScanSequence sequence_;                // being filled
  std::vector<ScanSequence> sequences_;  // tracked, that turn
  bool has_scans_ = false;
  std::optional<TimeNs> last_scan_ns_;
};

}  // namespace paloc

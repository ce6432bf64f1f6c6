#pragma once

#include <deque>
#include <optional>

#include "paloc/core/imu_sample.h"
#include "paloc/core/pose.h"
#include "paloc/core/stillness_settings.h"

namespace paloc {

/// Tells when the platform stands still: from the spread of the IMU's rate and force and its mean
/// rate over a window, and from the odometry's motion over the same window, which also sees an even
/// motion that no IMU feels. With hysteresis, so that a rest is not broken up.
class PALOC_EXPORT StillnessDetector {
 public:
  explicit StillnessDetector(const StillnessSettings& settings) : settings_(settings) {}

  /// In order of time.
  void addImu(const ImuSample& sample);
  /// A pose of the odometry; `continues` is false where the stream starts anew, or where there is
  /// none.
  void addOdometry(TimeNs t_ns, const Pose& T_odom_body, bool continues);

  /// Judges the window that ends at `t_ns`, once for each instant, in order of time. `bias_gyro`
  /// (rad/s) is taken off the mean rate.
  bool update(TimeNs t_ns, const Vec3& bias_gyro);

  /// Mean specific force (m/s2, body frame) from `since_ns` to the last judged instant.
  std::optional<Vec3> meanForce(TimeNs since_ns) const;

 private:
  struct StampedOdometry {
    TimeNs t_ns = 0;
    Pose T_odom_body;
  };

  bool imuAllowsRest(TimeNs t_ns, const Vec3& bias_gyro, double ratio) const;
  bool odometryAllowsRest(double ratio) const;
  void forgetBefore(TimeNs t_ns);

  StillnessSettings settings_;
  std::deque<ImuSample> samples_;
  std::deque<StampedOdometry> odometry_;
  bool odometry_seen_ = false;  // a stream that went on from one frame to the next
  TimeNs judged_ns_ = 0;
  bool at_rest_ = false;
};

}  // namespace paloc

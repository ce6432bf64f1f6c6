#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "paloc/core/time.h"
#include "paloc/core/types.h"

namespace paloc {

/// What is left in a scan of the motion while it was taken.
enum class ScanSkew {
  kNone,        ///< it was seen from one instant, or deskewed by an IMU
  kOfOdometry,  ///< it was deskewed by an odometry's motion, and has the errors of that
  kWhole,       ///< it was not deskewed at all
};

/// A LiDAR scan as the estimator sees it: undistorted to `end_ns`, in the body frame.
struct Scan {
  TimeNs start_ns = 0;  ///< stamp of the first point
  TimeNs end_ns = 0;    ///< the instant that the points are deskewed to; the node's time
  std::vector<Point3f> points_body;          ///< finite, m
  Vec3 sensor_position_body = Vec3::Zero();  ///< where the rays start (m)
  /// How many returns each point is the mean of, if the scan has been averaged; else empty.
  std::vector<std::uint16_t> returns = {};
  /// How long before `end_ns` each point was measured (s), where its time is known; else empty.
  std::vector<float> ages_s = {};
  /// Of a scan that was deskewed by the gyroscope as it reads, its bias left in, and by the
  /// accelerometer with a velocity from elsewhere: that velocity at `end_ns`, body frame (m/s).
  /// Such a scan can be deskewed better (see deskewedAnew()).
  std::optional<Vec3> v_body_assumed = {};
  ScanSkew skew = ScanSkew::kNone;
  /// Covariance (6 x 6) of what that does to the body's pose at `end_ns` by the scan, which is the
  /// same in scan after scan: tangent [position in the body frame (m), rotation on the right
  /// (rad)]. Set by withSkewTold().
  Mat6 skew_covariance = Mat6::Zero();
};

}  // namespace paloc

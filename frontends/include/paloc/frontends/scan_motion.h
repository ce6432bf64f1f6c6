#pragma once

#include <optional>
#include <vector>

#include "paloc/core/export.h"
#include "paloc/core/imu_sample.h"
#include "paloc/core/pose.h"
#include "paloc/frontends/tum_file.h"

namespace paloc {

/// What is known of the body's motion during a scan.
struct ScanMotionInput {
  TimeNs start_ns = 0, end_ns = 0;
  /// In order of time, from the last sample at or before the start to the first at or after the
  /// end; empty if there is no IMU, or a gap in it.
  std::vector<ImuSample> imu;
  /// T_odom_body in order of time, the first at the start, the last at the end; empty if not known.
  std::vector<StampedPose> odometry;
  std::optional<Vec3> up_body_end;  ///< unit vector, body frame at the end; needed with the IMU
  std::optional<Vec3>
      v_body_start;  ///< m/s, body frame at the start; used where odometry is not known
};

/// How the body moved during a scan.
///
/// With an IMU: rotation by integrating the gyroscope; translation by integrating the accelerometer
/// twice, with the velocity at the start chosen so that the way over the scan is the odometry's. An
/// error of the accelerometer (bias, gravity) of e m/s2 then moves no point by more than e T^2 / 8.
/// Without an IMU: straight and evenly between the odometry's poses, rotating at an even rate.
/// Without odometry: the gyroscope's rotation, and the accelerometer from the velocity at the start
/// where that is known, else no translation.
class PALOC_EXPORT ScanMotion {
 public:
  explicit ScanMotion(const ScanMotionInput& input);

  TimeNs startNs() const { return start_ns_; }
  TimeNs endNs() const { return end_ns_; }

  /// T_end_body: the body's pose at an instant of the scan, in the body's frame at its end.
  Pose bodyAt(TimeNs t_ns) const;

  /// Velocity at the end in the body frame there (m/s); nothing if no translation is known.
  const std::optional<Vec3>& vBodyEnd() const { return v_body_end_; }

  /// Whether rotation and accelerations are those that an IMU measured.
  bool byImu() const { return by_imu_; }

  double maxRate() const;  ///< rad/s

 private:
  /// From one knot to the next, rate and acceleration change linearly. In the body frame at the
  /// start.
  struct Knot {
    double t_s = 0;  ///< after the start
    Mat3 R = Mat3::Identity();
    Vec3 p = Vec3::Zero(), v = Vec3::Zero(), a = Vec3::Zero();
    Vec3 omega = Vec3::Zero();  ///< body frame
  };

  void integrateImu(const ScanMotionInput& input);
  void followOdometry(const ScanMotionInput& input);
  void addVelocity(const Vec3& v_start);
  Pose atStartFrame(double t_s) const;

  TimeNs start_ns_ = 0, end_ns_ = 0;
  std::vector<Knot> knots_;
  bool by_imu_ = false;
  bool even_steps_ = false;  ///< odometry alone: rate and velocity are a knot's own until the next
  Pose T_end_start_;
  std::optional<Vec3> v_body_end_;
};

}  // namespace paloc

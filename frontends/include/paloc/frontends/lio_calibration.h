#pragma once

#include "paloc/frontends/free_fall_scan.h"
#include "paloc/frontends/lio_state.h"

namespace paloc {

/// Offsets in the tangent space of LioCalibration.
namespace lio_calibration {
inline constexpr int kRotation = 0;    ///< rad, body frame, on the right: R Exp(w)
inline constexpr int kPosition = 3;    ///< m, body frame, additive
inline constexpr int kTimeOffset = 6;  ///< s, additive
inline constexpr int kDim = 7;
}  // namespace lio_calibration

using CalibrationVector = Eigen::Matrix<double, lio_calibration::kDim, 1>;
using CalibrationMatrix = Eigen::Matrix<double, lio_calibration::kDim, lio_calibration::kDim>;

/// What is wrong with the recording's word on where the LiDAR sits and on the clocks. A point q of
/// a scan, in the body frame by that word, is at s + moved + R (q - s), s the sensor's place in the
/// body by the recording; LiDAR time t is IMU time t + imu_late_s.
struct LioCalibration {
  Mat3 R = Mat3::Identity();
  Vec3 moved_body = Vec3::Zero();  ///< m
  double imu_late_s = 0;

  /// T_body_lidar with that put right.
  Pose corrected(const Pose& T_body_lidar) const {
    return {T_body_lidar.position + moved_body, R * T_body_lidar.rotation};
  }
};

/// How the sensor moves during a scan: what of it the calibration's derivatives need. Rate and
/// force are taken as even.
struct SensorMotion {
  SensorMotion() = default;
  PALOC_EXPORT SensorMotion(const FreeFallScan& scan, const Vec3& sensor_body);

  Vec3 sensor_body = Vec3::Zero();       ///< its place by the recording (m)
  Vec3 rate_body = Vec3::Zero();         ///< of the body (rad/s)
  Vec3 force_body = Vec3::Zero();        ///< specific (m/s2)
  Mat3 R_end_middle = Mat3::Identity();  ///< from the middle of the scan to its end
  bool lasts = false;  ///< a scan without duration tells nothing of the time offset
};

/// The state at the end of a scan of an odometry that finds its calibration, too.
///
/// Its tangent space is that of state and calibration, but that pose and gravity are those which
/// the LiDAR has, as errors of the body's: where the calibration alone is off, the body's pose is
/// off such that the LiDAR's is right. So a scan tells this pose, whatever the calibration, which
/// only shows as the body moves. In the tangent space of the body's own pose the direction that a
/// body at rest leaves open changes with the estimate, and the filter grows sure of what it cannot
/// know (G. Huang, A. Mourikis, S. Roumeliotis, "Observability-based Rules for Designing Consistent
/// EKF SLAM Estimators", 2010): sure to 0.2 degrees within 2 s of rest, and wrong by 1.5.
struct CalibratedLioState {
  static constexpr int kDim = lio::kDim + lio_calibration::kDim;  ///< [state, calibration]

  LioState x;
  LioCalibration calibration;
  SensorMotion sensor;
};

using CalibratedLioVector = Eigen::Matrix<double, CalibratedLioState::kDim, 1>;
using CalibratedLioMatrix =
    Eigen::Matrix<double, CalibratedLioState::kDim, CalibratedLioState::kDim>;

PALOC_EXPORT CalibratedLioState boxplus(const CalibratedLioState& s,
                                        const CalibratedLioVector& delta);
PALOC_EXPORT CalibratedLioVector boxminus(const CalibratedLioState& to,
                                          const CalibratedLioState& from);

/// Derivative of the LiDAR's pose and gravity, as errors of the body's, by the calibration, the
/// body being where it is (17 x 7): B. The errors e of state and c of calibration become [e + B c,
/// c] in the tangent space above.
///
/// To first order, with the rotation at the middle of the scan. How a wrong rotation bends the scan
/// is left out: it would take the rate as one more thing that the scan measures. It is half the
/// turn during the scan times the error at most, and vanishes with it.
PALOC_EXPORT Eigen::Matrix<double, lio::kDim, lio_calibration::kDim> lidarByCalibration(
    const CalibratedLioState& s);
/// S: errors of state and calibration to those of the tangent space above; its inverse where
/// `sign` is -1.
PALOC_EXPORT CalibratedLioMatrix toLidar(const CalibratedLioState& s, double sign = 1);

/// Derivative of what a scan measures (see jacobianOf<9>) by this tangent space (9 x 24).
PALOC_EXPORT Eigen::Matrix<double, 9, CalibratedLioState::kDim> calibratedToMeasured(
    const CalibratedLioState& s);

}  // namespace paloc

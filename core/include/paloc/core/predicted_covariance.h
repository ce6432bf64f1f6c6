#pragma once

#include "paloc/core/estimator_settings.h"
#include "paloc/core/export.h"
#include "paloc/core/odometry_frame.h"
#include "paloc/core/state.h"

namespace paloc {

/// Covariance (6 x 6, tangent [position (m), rotation on the right (rad)]) of where a platform may
/// have gone in `dt_s` seconds in which nothing measured its motion, about constant velocity.
PALOC_EXPORT Mat6 unmeasuredMotion(double dt_s, const EstimatorSettings& settings);

/// Covariance of the odometry's motion (OdometryFrame::motion_covariance) as far as its errors are
/// its own: what only its IMU told, with errors that are those of the estimator's IMU factor, is as
/// good as unknown.
PALOC_EXPORT Mat6 independentMotion(const OdometryFrame& frame);

/// What tells the motion since the last node.
enum class MotionSource { kImu, kOdometry, kNone };

/// The better one of those that there are.
constexpr MotionSource sourceOfMotion(bool imu, bool odometry) {
  if (imu) return MotionSource::kImu;
  return odometry ? MotionSource::kOdometry : MotionSource::kNone;
}

/// Covariance of the pose (6 x 6, likewise) `dt_s` after a state of covariance `last`. By IMU, what
/// that says of velocity, tilt and biases is added to first order and without their correlations:
/// position += dt v + dt^2/2 (b_a + g x tilt), rotation += dt b_g. By odometry, nothing: its own
/// noise over one step is small beside the pose's. By nothing, unmeasuredMotion().
PALOC_EXPORT Mat6 predictedCovariance(const StateMatrix& last, double dt_s, MotionSource source,
                                      const EstimatorSettings& settings);

}  // namespace paloc

#pragma once

#include <mrpt/poses/CPose3D.h>

#include <memory>
#include <variant>

#include "paloc/core/imu_sample.h"
#include "paloc/core/scan.h"

namespace paloc {

/// What an odometry front-end delivers for each scan.
struct OdometryFrame {
  TimeNs t_ns = 0;  ///< the end of the scan
  mrpt::poses::CPose3D T_odom_body;
  /// Whether `T_odom_body` and the one of the frame before belong to one uninterrupted stream, so
  /// that the motion between them is a measurement.
  bool continues = false;
  /// Covariance (6 x 6) of the motion T_last_body^-1 T_odom_body since the last frame, in the
  /// tangent space [position in the last body frame (m), rotation on the right (rad)]. Meaningful
  /// if `continues`.
  Mat6 motion_covariance = Mat6::Zero();
  /// Sum of e e^T over the directions e of the motion (6, orthonormal, in the same tangent space)
  /// that only the IMU told, or a guess, because the scan left them open or could not be used: the
  /// errors of such motions go on from frame to frame, as those of the velocity do, and the
  /// estimator takes nothing from them, but what it has of the IMU itself. Zero where there is
  /// none.
  Mat6 open_motion = Mat6::Zero();
  std::shared_ptr<const Scan> scan;  ///< may be null: a frame without a usable scan
};

/// What a front-end gives to the estimator, in order of time of availability.
using FrontendEvent = std::variant<ImuSample, OdometryFrame>;

}  // namespace paloc

#pragma once

#include "paloc/core/pose.h"

namespace paloc {

/// Covariance of the motion T_0^-1 T_1 (see OdometryFrame::motion_covariance) of two poses with
/// covariances (6 x 6, tangent of Pose) and `cross` = E[error of pose 1 . error of pose 0]: errors
/// that both share cancel.
Mat6 covarianceOfMotion(const Pose& T_0, const Pose& T_1, const Mat6& covariance_0,
                        const Mat6& covariance_1, const Mat6& cross);

/// Projector on the directions of the motion T_0^-1 T_1, in the same tangent space, along which the
/// pose T_1 was left open: `open` (6 x k, tangent of Pose), which need not be orthonormal. Columns
/// that hardly move the pose count for nothing.
Mat6 openDirectionsOfMotion(const Pose& T_0, const Eigen::Matrix<double, 6, Eigen::Dynamic>& open);

}  // namespace paloc

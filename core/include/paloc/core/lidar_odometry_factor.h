#pragma once

#include "paloc/core/relative_pose.h"
#include "paloc/core/robust_kernel.h"

namespace paloc {

/// LO, the LiDAR odometry (between) factor on the poses of two neighbouring nodes. PALoc, section
/// on LiDAR odometry factors.
///
///   r = [ R_i^T (t_j - t_i) - t_Z ; Log(R_Z^T R_i^T R_j) ]     (6, [m in body i, rad])
class PALOC_EXPORT LidarOdometryFactor {
 public:
  /// `covariance` (6 x 6, positive definite) of the motion, [position in body i, rotation on the
  /// right].
  LidarOdometryFactor(const Pose& T_i_j_measured, const Mat6& covariance, RobustKernel kernel = {});

  EdgeLinearization<6> linearize(const State& i, const State& j) const;
  const RobustKernel& kernel() const { return kernel_; }

 private:
  Pose T_i_j_measured_;
  Mat6 sqrt_information_;
  RobustKernel kernel_;
};

}  // namespace paloc

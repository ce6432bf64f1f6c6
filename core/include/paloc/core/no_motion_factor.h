#pragma once

#include "paloc/core/relative_pose.h"
#include "paloc/core/robust_kernel.h"

namespace paloc {

/// NM, the no-motion factor: the platform rests from node i to node j. PALoc, section on stationary
/// factors.
///
///   r = Log(T_i^-1 T_j) = [ R_i^T (t_j - t_i) ; Log(R_i^T R_j) ]     (6, [m in body i, rad])
class PALOC_EXPORT NoMotionFactor {
 public:
  NoMotionFactor(double sigma_position_m, double sigma_rotation_rad, RobustKernel kernel = {});

  EdgeLinearization<6> linearize(const State& i, const State& j) const;
  const RobustKernel& kernel() const { return kernel_; }

 private:
  double inverse_sigma_position_, inverse_sigma_rotation_;
  RobustKernel kernel_;
};

}  // namespace paloc

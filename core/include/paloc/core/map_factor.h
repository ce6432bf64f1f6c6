#pragma once

#include "paloc/core/linearization.h"
#include "paloc/core/robust_kernel.h"

namespace paloc {

/// DM, the degeneracy-aware map factor on the pose of one node. PALoc, section on map factors.
///
///   r = [ t - t_meas ; Log(R_meas^T R) ]        (6, [m in the map frame, rad])
///
/// with the information that the map gives, zero along the directions that it does not fix: those
/// rows of the whitening vanish, and the factor keeps what the map does know.
class PALOC_EXPORT MapFactor {
 public:
  /// `information` (6 x 6) in the tangent [position in the map frame, rotation on the right]; it
  /// may be rank-deficient.
  MapFactor(const Pose& T_map_body_measured, const Mat6& information, RobustKernel kernel = {});

  NodeLinearization<6> linearize(const State& x) const;
  const RobustKernel& kernel() const { return kernel_; }

 private:
  Pose T_map_body_measured_;
  Mat6 sqrt_information_;
  RobustKernel kernel_;
};

}  // namespace paloc

#pragma once

#include "paloc/core/linearization.h"
#include "paloc/core/robust_kernel.h"

namespace paloc {

/// ZV, the zero-velocity factor on one node at rest. PALoc, section on stationary factors.
///
///   r = v_k                                      (3, m/s in the map frame)
class PALOC_EXPORT ZeroVelocityFactor {
 public:
  explicit ZeroVelocityFactor(double sigma_mps, RobustKernel kernel = {});

  NodeLinearization<3> linearize(const State& x) const;
  const RobustKernel& kernel() const { return kernel_; }

 private:
  double inverse_sigma_;
  RobustKernel kernel_;
};

}  // namespace paloc

#pragma once

#include "paloc/core/linearization.h"
#include "paloc/core/robust_kernel.h"

namespace paloc {

/// Ties the gravity directions of two neighbouring nodes by a tiny random walk, so that all nodes
/// share one gravity and the window stays a chain.
///
///   r = g_j - g_i                                (3, 1)
class PALOC_EXPORT ConstantGravityFactor {
 public:
  /// `walk_sqrthz` (1/sqrt(Hz)) > 0, `dt_s` > 0: the time between the nodes.
  ConstantGravityFactor(double walk_sqrthz, double dt_s);

  EdgeLinearization<3> linearize(const State& i, const State& j) const;
  RobustKernel kernel() const { return {}; }

 private:
  double inverse_sigma_;
};

}  // namespace paloc

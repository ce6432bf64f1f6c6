#pragma once

#include "paloc/core/linearization.h"
#include "paloc/core/robust_kernel.h"

namespace paloc {

/// NG, the norm-constrained gravity factor on one node at rest. PALoc, section on the
/// norm-constrained gravity factor. With a_m the mean specific force while at rest (m/s2, body
/// frame) and u = (a_m - b_a) / |a_m - b_a|, which points up,
///
///   r = [ R u + g ; |g| - 1 ]                    (4, 1)
///
/// where g, the direction of gravity in the map, points down.
class PALOC_EXPORT GravityFactor {
 public:
  /// `sigma_direction_rad`: of the mean force's direction; `sigma_magnitude`: of |g| about one.
  GravityFactor(const Vec3& mean_acc_body, double sigma_direction_rad, double sigma_magnitude,
                RobustKernel kernel = {});

  NodeLinearization<4> linearize(const State& x) const;
  const RobustKernel& kernel() const { return kernel_; }

 private:
  Vec3 mean_acc_body_;
  double inverse_sigma_direction_, inverse_sigma_magnitude_;
  RobustKernel kernel_;
};

}  // namespace paloc

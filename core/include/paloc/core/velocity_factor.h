#pragma once

#include "paloc/core/linearization.h"
#include "paloc/core/robust_kernel.h"

namespace paloc {

/// Ties velocities to positions between two neighbouring nodes that no IMU data joins, so that the
/// velocity stays defined: the mean of both velocities is that of the motion, up to what the
/// platform may accelerate.
///
///   r = (t_j - t_i) / dt - (v_i + v_j) / 2       (3, m/s in the map frame)
class PALOC_EXPORT VelocityFactor {
 public:
  /// `dt_s` > 0: the time between the nodes.
  VelocityFactor(double dt_s, double sigma_mps);

  EdgeLinearization<3> linearize(const State& i, const State& j) const;
  RobustKernel kernel() const { return {}; }

 private:
  double dt_s_, inverse_sigma_;
};

}  // namespace paloc

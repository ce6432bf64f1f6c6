#pragma once

#include "paloc/core/imu_noise.h"
#include "paloc/core/linearization.h"
#include "paloc/core/robust_kernel.h"

namespace paloc {

/// The random walk of the IMU biases between two neighbouring nodes, the last rows of IM in the
/// PALoc paper; a factor of its own so that it also ties nodes without IMU data between them.
///
///   r = [ b_a,j - b_a,i ; b_g,j - b_g,i ]        (6, [m/s2, rad/s])
class PALOC_EXPORT BiasWalkFactor {
 public:
  /// `dt_s` > 0: the time between the nodes.
  BiasWalkFactor(const ImuNoise& noise, double dt_s);

  EdgeLinearization<6> linearize(const State& i, const State& j) const;
  RobustKernel kernel() const { return {}; }

 private:
  double inverse_sigma_acc_, inverse_sigma_gyro_;
};

}  // namespace paloc

#include "paloc/core/zero_velocity_factor.h"

namespace paloc {

ZeroVelocityFactor::ZeroVelocityFactor(double sigma_mps, RobustKernel kernel)
    : inverse_sigma_(1 / sigma_mps), kernel_(kernel) {}

NodeLinearization<3> ZeroVelocityFactor::linearize(const State& x) const {
  NodeLinearization<3> l;
  l.residual = inverse_sigma_ * x.v_map;
  l.jacobian.block<3, 3>(0, tangent::kVelocity) = inverse_sigma_ * Mat3::Identity();
  return l;
}

}  // namespace paloc

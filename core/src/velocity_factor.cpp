#include "paloc/core/velocity_factor.h"

namespace paloc {

VelocityFactor::VelocityFactor(double dt_s, double sigma_mps)
    : dt_s_(dt_s), inverse_sigma_(1 / sigma_mps) {}

EdgeLinearization<3> VelocityFactor::linearize(const State& i, const State& j) const {
  const Mat3 identity = inverse_sigma_ * Mat3::Identity();
  EdgeLinearization<3> l;
  l.residual = inverse_sigma_ * ((j.T_map_body.position - i.T_map_body.position) / dt_s_ -
                                 0.5 * (i.v_map + j.v_map));
  l.jacobian_i.block<3, 3>(0, tangent::kPosition) = -identity / dt_s_;
  l.jacobian_j.block<3, 3>(0, tangent::kPosition) = identity / dt_s_;
  l.jacobian_i.block<3, 3>(0, tangent::kVelocity) = -0.5 * identity;
  l.jacobian_j.block<3, 3>(0, tangent::kVelocity) = -0.5 * identity;
  return l;
}

}  // namespace paloc

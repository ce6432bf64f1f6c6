#include "paloc/core/constant_gravity_factor.h"

#include <cmath>

namespace paloc {

ConstantGravityFactor::ConstantGravityFactor(double walk_sqrthz, double dt_s)
    : inverse_sigma_(1 / (walk_sqrthz * std::sqrt(dt_s))) {}

EdgeLinearization<3> ConstantGravityFactor::linearize(const State& i, const State& j) const {
  EdgeLinearization<3> l;
  l.residual = inverse_sigma_ * (j.gravity_map - i.gravity_map);
  l.jacobian_j.block<3, 3>(0, tangent::kGravity) = inverse_sigma_ * Mat3::Identity();
  l.jacobian_i = -l.jacobian_j;
  return l;
}

}  // namespace paloc

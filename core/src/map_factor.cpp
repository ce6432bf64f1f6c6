#include "paloc/core/map_factor.h"

#include "paloc/core/square_root_information.h"

namespace paloc {

MapFactor::MapFactor(const Pose& T_map_body_measured, const Mat6& information, RobustKernel kernel)
    : T_map_body_measured_(T_map_body_measured),
      sqrt_information_(sqrtOfInformation(information)),
      kernel_(kernel) {}

NodeLinearization<6> MapFactor::linearize(const State& x) const {
  NodeLinearization<6> l;
  l.residual = boxminus(x.T_map_body, T_map_body_measured_);
  l.jacobian.block<3, 3>(0, tangent::kPosition).setIdentity();
  l.jacobian.block<3, 3>(3, tangent::kRotation) = so3::rightJacobianInverse(l.residual.tail<3>());
  whiten(sqrt_information_, l);
  return l;
}

}  // namespace paloc

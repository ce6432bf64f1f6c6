#include "paloc/core/relative_pose.h"

namespace paloc {

EdgeLinearization<6> relativePoseResidual(const State& i, const State& j,
                                          const Pose& T_i_j_measured) {
  const Mat3 R_i_map = i.T_map_body.rotation.transpose();
  const Pose T_i_j = i.T_map_body.inverse() * j.T_map_body;
  EdgeLinearization<6> l;
  l.residual = boxminus(T_i_j, T_i_j_measured);
  l.jacobian_i.block<3, 3>(0, tangent::kPosition) = -R_i_map;
  l.jacobian_i.block<3, 3>(0, tangent::kRotation) = so3::hat(T_i_j.position);
  l.jacobian_j.block<3, 3>(0, tangent::kPosition) = R_i_map;
  const Mat3 jr_inverse = so3::rightJacobianInverse(l.residual.tail<3>());
  l.jacobian_i.block<3, 3>(3, tangent::kRotation) = -jr_inverse * T_i_j.rotation.transpose();
  l.jacobian_j.block<3, 3>(3, tangent::kRotation) = jr_inverse;
  return l;
}

}  // namespace paloc

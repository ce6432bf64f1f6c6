#include "paloc/core/gravity_factor.h"

namespace paloc {

GravityFactor::GravityFactor(const Vec3& mean_acc_body, double sigma_direction_rad,
                             double sigma_magnitude, RobustKernel kernel)
    : mean_acc_body_(mean_acc_body),
      inverse_sigma_direction_(1 / sigma_direction_rad),
      inverse_sigma_magnitude_(1 / sigma_magnitude),
      kernel_(kernel) {}

NodeLinearization<4> GravityFactor::linearize(const State& x) const {
  const Vec3 force_body = mean_acc_body_ - x.bias_acc;
  const double magnitude = force_body.norm();
  const Vec3 up_body = force_body / magnitude;
  const Mat3& R_map_body = x.T_map_body.rotation;

  NodeLinearization<4> l;
  l.residual << R_map_body * up_body + x.gravity_map, x.gravity_map.norm() - 1;
  l.jacobian.block<3, 3>(0, tangent::kRotation) = -R_map_body * so3::hat(up_body);
  l.jacobian.block<3, 3>(0, tangent::kBiasAcc) =
      -R_map_body * (Mat3::Identity() - up_body * up_body.transpose()) / magnitude;
  l.jacobian.block<3, 3>(0, tangent::kGravity).setIdentity();
  l.jacobian.block<1, 3>(3, tangent::kGravity) = x.gravity_map.normalized().transpose();

  Eigen::Vector4d weights;
  weights << Vec3::Constant(inverse_sigma_direction_), inverse_sigma_magnitude_;
  whiten(weights.asDiagonal(), l);
  return l;
}

}  // namespace paloc

#include "paloc/frontends/lio_state.h"

#include <cmath>

namespace paloc {

LioState boxplus(const LioState& x, const LioVector& delta) {
  LioState y;
  y.T_odom_body = boxplus(x.T_odom_body, Vec6(delta.segment<6>(lio::kPosition)));
  y.v_odom = x.v_odom + delta.segment<3>(lio::kVelocity);
  y.bias_acc = x.bias_acc + delta.segment<3>(lio::kBiasAcc);
  y.bias_gyro = x.bias_gyro + delta.segment<3>(lio::kBiasGyro);
  const Vec3 turn = tangentBasis(x.gravity_odom) * delta.segment<2>(lio::kGravity);
  y.gravity_odom = so3::exp(turn) * x.gravity_odom;
  return y;
}

LioVector boxminus(const LioState& to, const LioState& from) {
  LioVector delta;
  delta.segment<6>(lio::kPosition) = boxminus(to.T_odom_body, from.T_odom_body);
  delta.segment<3>(lio::kVelocity) = to.v_odom - from.v_odom;
  delta.segment<3>(lio::kBiasAcc) = to.bias_acc - from.bias_acc;
  delta.segment<3>(lio::kBiasGyro) = to.bias_gyro - from.bias_gyro;
  const Vec3 axis = from.gravity_odom.cross(to.gravity_odom);
  const double sine = axis.norm(), cosine = from.gravity_odom.dot(to.gravity_odom);
  const double scale = sine > 0 ? std::atan2(sine, cosine) / sine : 0;
  delta.segment<2>(lio::kGravity) = tangentBasis(from.gravity_odom).transpose() * (scale * axis);
  return delta;
}

}  // namespace paloc

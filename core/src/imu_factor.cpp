#include "paloc/core/imu_factor.h"

#include "paloc/core/square_root_information.h"

namespace paloc {

ImuFactor::ImuFactor(const Preintegration& preintegration, double gravity_mps2)
    : preintegration_(preintegration),
      sqrt_information_(sqrtInformationOfCovariance(preintegration.covariance)),
      gravity_mps2_(gravity_mps2) {}

ImuFactor::Corrected ImuFactor::correctFor(const State& i) const {
  const Preintegration& p = preintegration_;
  const Vec3 d_acc = i.bias_acc - p.bias_acc;
  const Vec3 d_gyro = i.bias_gyro - p.bias_gyro;
  Corrected c;
  c.delta_p = p.delta_p + p.dp_dbias_acc * d_acc + p.dp_dbias_gyro * d_gyro;
  c.delta_v = p.delta_v + p.dv_dbias_acc * d_acc + p.dv_dbias_gyro * d_gyro;
  c.rotation_correction = p.dR_dbias_gyro * d_gyro;
  c.delta_R = p.delta_R * so3::exp(c.rotation_correction);
  return c;
}

State ImuFactor::predict(const State& i) const {
  const Corrected c = correctFor(i);
  const double dt = preintegration_.dt_s;
  const Vec3 gravity = gravity_mps2_ * i.gravity_map;
  const Mat3& R = i.T_map_body.rotation;
  State j = i;
  j.T_map_body.position += i.v_map * dt + 0.5 * dt * dt * gravity + R * c.delta_p;
  j.T_map_body.rotation = so3::normalized(R * c.delta_R);
  j.v_map += gravity * dt + R * c.delta_v;
  return j;
}

EdgeLinearization<9> ImuFactor::linearize(const State& i, const State& j) const {
  using namespace tangent;
  const Preintegration& p = preintegration_;
  const Corrected c = correctFor(i);
  const double dt = p.dt_s;
  const Mat3 R_i_map = i.T_map_body.rotation.transpose();
  const Vec3 gravity = gravity_mps2_ * i.gravity_map;
  const Vec3 moved_i = R_i_map * (j.T_map_body.position - i.T_map_body.position - i.v_map * dt -
                                  0.5 * dt * dt * gravity);
  const Vec3 sped_up_i = R_i_map * (j.v_map - i.v_map - gravity * dt);
  const Mat3 R_i_j = R_i_map * j.T_map_body.rotation;
  const Vec3 r_rotation = so3::log(c.delta_R.transpose() * R_i_j);
  const Mat3 jr_inverse = so3::rightJacobianInverse(r_rotation);

  EdgeLinearization<9> l;
  l.residual << moved_i - c.delta_p, r_rotation, sped_up_i - c.delta_v;

  l.jacobian_i.block<3, 3>(0, kPosition) = -R_i_map;
  l.jacobian_i.block<3, 3>(0, kRotation) = so3::hat(moved_i);
  l.jacobian_i.block<3, 3>(0, kVelocity) = -dt * R_i_map;
  l.jacobian_i.block<3, 3>(0, kBiasAcc) = -p.dp_dbias_acc;
  l.jacobian_i.block<3, 3>(0, kBiasGyro) = -p.dp_dbias_gyro;
  l.jacobian_i.block<3, 3>(0, kGravity) = (-0.5 * dt * dt * gravity_mps2_) * R_i_map;
  l.jacobian_j.block<3, 3>(0, kPosition) = R_i_map;

  l.jacobian_i.block<3, 3>(3, kRotation) = -jr_inverse * R_i_j.transpose();
  l.jacobian_i.block<3, 3>(3, kBiasGyro) = -jr_inverse * so3::exp(r_rotation).transpose() *
                                           so3::rightJacobian(c.rotation_correction) *
                                           p.dR_dbias_gyro;
  l.jacobian_j.block<3, 3>(3, kRotation) = jr_inverse;

  l.jacobian_i.block<3, 3>(6, kRotation) = so3::hat(sped_up_i);
  l.jacobian_i.block<3, 3>(6, kVelocity) = -R_i_map;
  l.jacobian_i.block<3, 3>(6, kBiasAcc) = -p.dv_dbias_acc;
  l.jacobian_i.block<3, 3>(6, kBiasGyro) = -p.dv_dbias_gyro;
  l.jacobian_i.block<3, 3>(6, kGravity) = (-dt * gravity_mps2_) * R_i_map;
  l.jacobian_j.block<3, 3>(6, kVelocity) = R_i_map;

  whiten(sqrt_information_, l);
  return l;
}

}  // namespace paloc

#include "paloc/frontends/lio_prediction.h"

namespace paloc {

using lio::kBiasAcc;
using lio::kBiasGyro;
using lio::kGravity;
using lio::kPosition;
using lio::kRotation;
using lio::kVelocity;

LioState predictLio(const LioState& x, const Preintegration& imu) {
  const double dt = imu.dt_s;
  const Mat3& R = x.T_odom_body.rotation;
  LioState y = x;
  y.T_odom_body.position += dt * x.v_odom + 0.5 * dt * dt * x.gravity_odom + R * imu.delta_p;
  y.T_odom_body.rotation = so3::normalized(R * imu.delta_R);
  y.v_odom += dt * x.gravity_odom + R * imu.delta_v;
  return y;
}

LioMatrix lioTransition(const LioState& x, const Preintegration& imu) {
  const double dt = imu.dt_s;
  const Mat3& R = x.T_odom_body.rotation;
  const Eigen::Matrix<double, 3, 2> gravity =
      -so3::hat(x.gravity_odom) * tangentBasis(x.gravity_odom);
  LioMatrix F = LioMatrix::Identity();
  F.block<3, 3>(kPosition, kRotation) = -R * so3::hat(imu.delta_p);
  F.block<3, 3>(kPosition, kVelocity) = dt * Mat3::Identity();
  F.block<3, 3>(kPosition, kBiasAcc) = R * imu.dp_dbias_acc;
  F.block<3, 3>(kPosition, kBiasGyro) = R * imu.dp_dbias_gyro;
  F.block<3, 2>(kPosition, kGravity) = 0.5 * dt * dt * gravity;
  F.block<3, 3>(kRotation, kRotation) = imu.delta_R.transpose();
  F.block<3, 3>(kRotation, kBiasGyro) = imu.dR_dbias_gyro;
  F.block<3, 3>(kVelocity, kRotation) = -R * so3::hat(imu.delta_v);
  F.block<3, 3>(kVelocity, kBiasAcc) = R * imu.dv_dbias_acc;
  F.block<3, 3>(kVelocity, kBiasGyro) = R * imu.dv_dbias_gyro;
  F.block<3, 2>(kVelocity, kGravity) = dt * gravity;
  return F;
}

LioMatrix lioProcessNoise(const LioState& x, const Preintegration& imu, const ImuNoise& noise) {
  // The preintegration's errors of position and velocity are in the body frame of the start.
  Eigen::Matrix<double, 9, 9> to_odom = Eigen::Matrix<double, 9, 9>::Identity();
  to_odom.block<3, 3>(0, 0) = to_odom.block<3, 3>(6, 6) = x.T_odom_body.rotation;
  LioMatrix Q = LioMatrix::Zero();
  Q.topLeftCorner<9, 9>() = to_odom * imu.covariance * to_odom.transpose();
  const auto walk = [&](double density) { return density * density * imu.dt_s; };
  Q.diagonal().segment<3>(kBiasAcc).setConstant(walk(noise.accelerometer_bias_walk_mps3_sqrthz));
  Q.diagonal().segment<3>(kBiasGyro).setConstant(walk(noise.gyroscope_bias_walk_radps2_sqrthz));
  return Q;
}

}  // namespace paloc

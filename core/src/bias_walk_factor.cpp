#include "paloc/core/bias_walk_factor.h"

#include <cmath>

namespace paloc {

BiasWalkFactor::BiasWalkFactor(const ImuNoise& noise, double dt_s)
    : inverse_sigma_acc_(1 / (noise.accelerometer_bias_walk_mps3_sqrthz * std::sqrt(dt_s))),
      inverse_sigma_gyro_(1 / (noise.gyroscope_bias_walk_radps2_sqrthz * std::sqrt(dt_s))) {}

EdgeLinearization<6> BiasWalkFactor::linearize(const State& i, const State& j) const {
  EdgeLinearization<6> l;
  l.residual << inverse_sigma_acc_ * (j.bias_acc - i.bias_acc),
      inverse_sigma_gyro_ * (j.bias_gyro - i.bias_gyro);
  l.jacobian_j.block<3, 3>(0, tangent::kBiasAcc) = inverse_sigma_acc_ * Mat3::Identity();
  l.jacobian_j.block<3, 3>(3, tangent::kBiasGyro) = inverse_sigma_gyro_ * Mat3::Identity();
  l.jacobian_i = -l.jacobian_j;
  return l;
}

}  // namespace paloc

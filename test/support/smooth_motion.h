#pragma once

#include <cmath>

#include "paloc/core/imu_sample.h"
#include "paloc/core/state.h"

namespace paloc::test {

/// A smooth made-up motion with everything analytic: the body circles, bobs and turns. It starts at
/// t = 0 from whatever the sines give, not from rest.
struct SmoothMotion {
  double gravity_mps2 = 9.80665;
  Vec3 bias_acc = Vec3::Zero(), bias_gyro = Vec3::Zero();  ///< that the IMU adds

  Vec3 position(double t) const {
    return {3 * std::sin(0.4 * t), 2 * std::cos(0.3 * t), 1.5 + 0.05 * std::sin(8 * t)};
  }
  Vec3 velocity(double t) const {
    return {1.2 * std::cos(0.4 * t), -0.6 * std::sin(0.3 * t), 0.4 * std::cos(8 * t)};
  }
  Vec3 acceleration(double t) const {
    return {-0.48 * std::sin(0.4 * t), -0.18 * std::cos(0.3 * t), -3.2 * std::sin(8 * t)};
  }
  // R = Rz(yaw) Rx(roll) with both angles known functions of time.
  double yaw(double t) const { return 0.5 * t + 0.3 * std::sin(t); }
  double roll(double t) const { return 0.1 * std::sin(2 * t); }
  Mat3 rotation(double t) const {
    return so3::exp(yaw(t) * Vec3::UnitZ()) * so3::exp(roll(t) * Vec3::UnitX());
  }
  Vec3 omega(double t) const {  // rad/s, body frame
    const double yaw_rate = 0.5 + 0.3 * std::cos(t), roll_rate = 0.2 * std::cos(2 * t);
    return roll_rate * Vec3::UnitX() +
           so3::exp(roll(t) * Vec3::UnitX()).transpose() * (yaw_rate * Vec3::UnitZ());
  }

  Pose pose(double t) const { return {position(t), rotation(t)}; }
  State state(double t) const {
    State x;
    x.T_map_body = pose(t);
    x.v_map = velocity(t);
    x.bias_acc = bias_acc;
    x.bias_gyro = bias_gyro;
    return x;
  }
  ImuSample imu(double t) const {
    ImuSample sample;
    sample.t_ns = nsFromSeconds(t);
    sample.acc_body =
        rotation(t).transpose() * (acceleration(t) + gravity_mps2 * Vec3::UnitZ()) + bias_acc;
    sample.omega_body = omega(t) + bias_gyro;
    return sample;
  }
};

}  // namespace paloc::test

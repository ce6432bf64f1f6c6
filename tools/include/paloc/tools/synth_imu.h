#pragma once

#include <cstdint>
#include <vector>

#include "paloc/core/imu_noise.h"
#include "paloc/core/imu_sample.h"
#include "paloc/tools/synth_motion.h"

namespace paloc::synth {

inline constexpr double kGravity = 9.80665;  ///< m/s2, along -z of the map

/// Errors of a simulated IMU. Defaults: a Sensonor STIM300.
struct ImuModel {
  double rate_hz = 200;
  ImuNoise noise{1.2e-3, 4.4e-5, 5e-5, 2e-6};
  double initial_bias_acc_mps2 = 0.02;  ///< standard deviation at switch-on
  double initial_bias_gyro_radps = 1e-3;
};

/// One instant: what the IMU says and what is true.
struct ImuTruth {
  ImuSample sample;
  MotionState state;
  Vec3 bias_acc = Vec3::Zero();   ///< m/s2, body frame
  Vec3 bias_gyro = Vec3::Zero();  ///< rad/s, body frame
};

/// Samples of specific force and rate at their stamps (not means over an interval), from `first_ns`
/// on, none later than `last_ns`.
std::vector<ImuTruth> simulateImu(const ImuModel& model, const Motion& motion, TimeNs first_ns,
                                  TimeNs last_ns, std::uint64_t seed);

}  // namespace paloc::synth

#include "paloc/tools/synth_imu.h"

#include <cmath>

#include "paloc/tools/synth_random.h"

namespace paloc::synth {
namespace {

Vec3 normal3(RandomStream& random) {
  const double x = random.normal(), y = random.normal(), z = random.normal();
  return {x, y, z};
}

}  // namespace

std::vector<ImuTruth> simulateImu(const ImuModel& model, const Motion& motion, TimeNs first_ns,
                                  TimeNs last_ns, std::uint64_t seed) {
  RandomStream random(seed, RandomPurpose::kImu, 0);
  const TimeNs interval = nsFromSeconds(1 / model.rate_hz);
  const double dt = secondsBetween(0, interval), root_rate = std::sqrt(1 / dt),
               root_dt = std::sqrt(dt);
  const ImuNoise& noise = model.noise;
  Vec3 bias_acc = model.initial_bias_acc_mps2 * normal3(random);
  Vec3 bias_gyro = model.initial_bias_gyro_radps * normal3(random);
  std::vector<ImuTruth> result;
  for (TimeNs t = first_ns; t <= last_ns; t += interval) {
    ImuTruth now;
    now.state = motion.at(t);
    now.bias_acc = bias_acc;
    now.bias_gyro = bias_gyro;
    now.sample.t_ns = t;
    const Vec3 force_map = now.state.a_map + kGravity * Vec3::UnitZ();
    now.sample.acc_body =
        now.state.T_map_body.rotation.transpose() * force_map + bias_acc +
        noise.accelerometer_noise_density_mps2_sqrthz * root_rate * normal3(random);
    now.sample.omega_body =
        now.state.omega_body + bias_gyro +
        noise.gyroscope_noise_density_radps_sqrthz * root_rate * normal3(random);
    result.push_back(now);
    bias_acc += noise.accelerometer_bias_walk_mps3_sqrthz * root_dt * normal3(random);
    bias_gyro += noise.gyroscope_bias_walk_radps2_sqrthz * root_dt * normal3(random);
  }
  return result;
}

}  // namespace paloc::synth

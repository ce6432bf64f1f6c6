#include "section.h"

namespace paloc {

std::vector<Setting> fastLioSettings() {
  using S = FastLioSettings;
  Section s(
      "fast_lio", [](auto& config) -> auto& { return config.frontend.fast_lio; });
  s.count("map_points", &S::map_points, {100, 1e6},
          "Front-end fast_lio: points of a scan that are put into the local map.");
  s.count("max_iterations", &S::max_iterations, {1, 1000}, "Steps of an update.");
  s.number("sigma_velocity_mps", &S::sigma_velocity_mps, "m/s", {1e-3, 100},
           "Standard deviation of the first velocity, each axis, where the IMU is not at rest.");
  s.number("sigma_bias_acc_mps2", &S::sigma_bias_acc_mps2, "m/s2", {1e-6, 10},
           "Standard deviation of the accelerometer's bias at the start.");
  s.number("sigma_bias_gyro_radps", &S::sigma_bias_gyro_radps, "rad/s", {1e-8, 1},
           "Standard deviation of the gyroscope's bias at the start.");
  s.number("sigma_acceleration_mps2", &S::sigma_acceleration_mps2, "m/s2", {1e-3, 100},
           "Standard deviation of the body's mean acceleration during the first scan, where the "
           "IMU is not at rest: so far off may be the force that tells where up is.");
  return std::move(s).rows();
}

}  // namespace paloc

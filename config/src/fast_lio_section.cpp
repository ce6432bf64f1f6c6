#include "section.h"

namespace paloc {

std::vector<Setting> fastLioSettings() {
  using S = FastLioSettings;
  Section s(
      "fast_lio", [](auto& config) -> auto& { return config.frontend.fast_lio; });
  s.number("voxel_m", &S::voxel_m, "m", {0.05, 10},
           "Front-end fast_lio: edge of the local map's smallest voxels.");
  s.number("level_factor", &S::level_factor, "", {1.1, 10},
           "From one size of voxels to the next; the larger serve where points are few.");
  s.count("levels", &S::levels, {1, 8}, "Sizes of voxels.");
  s.count("max_voxels", &S::max_voxels, {1000, 1e8},
          "Voxels of each size that the local map keeps; the oldest are forgotten.");
  s.number("max_distance_m", &S::max_distance_m, "m", {1, 10000},
           "Voxels further away are the first to be forgotten.");
  s.count("registration_points", &S::registration_points, {100, 1e6},
          "Points of a scan that are registered, spread evenly over the surfaces.");
  s.count("map_points", &S::map_points, {100, 1e6},
          "Points of a scan that are put into the local map.");
  s.count("max_iterations", &S::max_iterations, {1, 1000}, "Steps of an update.");
  s.number("noise_floor_m", &S::noise_floor_m, "m", {1e-4, 1},
           "Least standard deviation of a point about its plane.");
  s.number("max_gate_m", &S::max_gate_m, "m", {0.01, 100},
           "Points further from their plane are never used.");
  s.number("max_gap_s", &S::max_gap_s, "s", {0.01, 60},
           "After a longer pause of the scans the odometry begins anew.");
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

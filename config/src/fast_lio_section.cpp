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
  s.flag("estimate_extrinsic", &S::estimate_extrinsic,
         "Whether to find what is wrong with T_body_lidar on the way; the scans handed on have it "
         "put right.");
  s.number("sigma_extrinsic_rotation_rad", &S::sigma_extrinsic_rotation_rad, "rad", {1e-6, 1},
           "Standard deviation of the rotation of T_body_lidar, about each axis.");
  s.number("sigma_extrinsic_position_m", &S::sigma_extrinsic_position_m, "m", {1e-6, 10},
           "Standard deviation of the position of T_body_lidar, each axis.");
  s.flag("estimate_time_offset", &S::estimate_time_offset,
         "Whether to find how late the IMU's stamps are against the LiDAR's; those of the IMU are "
         "put right.");
  s.number("sigma_time_offset_s", &S::sigma_time_offset_s, "s", {1e-6, 0.1},
           "Standard deviation of that offset.");
  return std::move(s).rows();
}

}  // namespace paloc

#pragma once

namespace paloc {

/// Settings of the front-end `fast_lio`, besides those of its local map.
struct FastLioSettings {
  int map_points = 9000;  ///< of a scan that go into the local map, spread evenly over the surfaces
  int max_iterations = 8;

  // What is known before the first scan, as standard deviations of each axis.
  double sigma_velocity_mps = 1.5;  ///< unless the IMU is at rest
  double sigma_bias_acc_mps2 = 0.1;
  double sigma_bias_gyro_radps = 0.01;
  double sigma_acceleration_mps2 = 2;  ///< of the body during the first scan, unless it is at rest

  /// Whether T_body_lidar and the offset between the clocks of LiDAR and IMU are states, too; how
  /// far the recording's are off before the first scan, as standard deviations.
  bool estimate_extrinsic = false;
  double sigma_extrinsic_rotation_rad = 0.03;  ///< about each axis
  double sigma_extrinsic_position_m = 0.05;    ///< of each axis
  bool estimate_time_offset = false;
  double sigma_time_offset_s = 0.01;
};

}  // namespace paloc

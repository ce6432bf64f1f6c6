#pragma once

namespace paloc {

/// Settings of the front-end `fast_lio`.
struct FastLioSettings {
  double voxel_m = 0.2;            ///< edge of the local map's smallest voxels
  double level_factor = 2.5;       ///< from one size of voxels to the next
  int levels = 3;                  ///< sizes of voxels
  int max_voxels = 150'000;        ///< of each size, before the oldest are forgotten
  double max_distance_m = 100;     ///< voxels further away are the first to be forgotten
  int registration_points = 3000;  ///< of a scan, spread evenly over the surfaces
  int map_points = 9000;           ///< of a scan that go into the local map, likewise
  int max_iterations = 8;
  double noise_floor_m = 0.005;  ///< least standard deviation of a point about its plane
  double max_gate_m = 0.5;       ///< residuals beyond are never used
  double max_gap_s = 2;          ///< without a scan: longer, and the odometry begins anew

  // What is known before the first scan, as standard deviations of each axis.
  double sigma_velocity_mps = 1.5;  ///< unless the IMU is at rest
  double sigma_bias_acc_mps2 = 0.1;
  double sigma_bias_gyro_radps = 0.01;
  double sigma_acceleration_mps2 = 2;  ///< of the body during the first scan, unless it is at rest
};

}  // namespace paloc

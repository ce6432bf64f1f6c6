#pragma once

namespace paloc {

/// Settings of the front-end `lio_sam`.
struct LioSamSettings {
  // Features of a scan.
  double feature_window_m = 0.3;   ///< way along a ring, to each side, whose bend is looked at
  double edge_bend = 0.3;          ///< bend from which on a point may be an edge (see RingFeatures)
  double plane_bend = 0.2;         ///< and up to which it may lie on a plane
  double range_noise_m = 0.02;     ///< standard deviation of a range, for both
  int edges_per_sector = 3;        ///< at most, of each sixth of a ring
  int registration_planes = 3000;  ///< plane points that are registered
  int registration_edges = 400;    ///< edge points that are registered, at most

  // Key frames and the local map that they make.
  double key_frame_distance_m = 0.5;  ///< since the last key frame: a new one
  double key_frame_turn_rad = 0.2;    ///< likewise
  double key_frame_matched = 0.4;     ///< share of a scan on the map below which it becomes one
  int max_key_frames = 60;            ///< of the local map, before the oldest are forgotten
  double max_distance_m = 60;         ///< key frames further away are the first to be forgotten
  int map_planes = 9000;              ///< plane points of a key frame, spread over the surfaces
  double voxel_m = 0.2;               ///< edge of the smallest voxels of planes
  double level_factor = 2.5;          ///< from one size of them to the next
  int levels = 3;                     ///< sizes of voxels
  double line_voxel_m = 0.5;          ///< edge of the voxels of lines

  // Registration.
  int max_iterations = 8;
  double noise_floor_m = 0.005;  ///< least standard deviation of a point about its plane
  double max_gate_m = 0.5;       ///< residuals beyond are never used
  double max_gap_s = 2;          ///< without a scan: longer, and the odometry begins anew
  double lag_s = 2;              ///< length of the smoother's window

  // What is known before the first scan, as standard deviations of each axis.
  double sigma_velocity_mps = 1.5;  ///< unless the IMU is at rest
  double sigma_bias_acc_mps2 = 0.1;
  double sigma_bias_gyro_radps = 0.01;
  double sigma_acceleration_mps2 = 2;  ///< of the body during the first scan, unless it is at rest
};

}  // namespace paloc

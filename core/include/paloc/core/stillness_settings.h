#pragma once

namespace paloc {

/// When the platform counts as standing still, and how firmly the stationary factors hold it.
struct StillnessSettings {
  bool enabled = true;
  double window_s = 0.5;  ///< over which rest is judged

  // Within the window, to begin a rest; to end it, `leave_ratio` times as much.
  double max_rate_deviation_radps = 0.012;  ///< standard deviation of the angular rate
  double max_force_deviation_mps2 = 0.1;    ///< standard deviation of the specific force
  double max_mean_rate_radps = 0.015;       ///< mean angular rate less bias
  double max_odometry_speed_mps = 0.05;     ///< way over the window, by the odometry
  double max_odometry_rate_radps = 0.03;    ///< angle turned over the window, by the odometry
  double leave_ratio = 1.6;

  double zero_velocity_sigma_mps = 0.01;
  double no_motion_sigma_position_m = 0.002;
  double no_motion_sigma_rotation_rad = 0.001;
  double gravity_sigma_direction_rad = 0.005;
  double gravity_sigma_magnitude = 0.001;
};

}  // namespace paloc

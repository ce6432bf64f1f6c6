#include "section.h"

namespace paloc {

std::vector<Setting> estimatorSettings() {
  using S = EstimatorSettings;
  Section s(
      "estimator", [](auto& config) -> auto& { return config.estimator; });
  s.number("gravity_mps2", &S::gravity_mps2, "m/s2", {9.5, 10.1}, "Local strength of gravity.");
  s.number("max_imu_gap_s", &S::max_imu_gap_s, "s", {1e-3, 10},
           "IMU samples further apart than this are not integrated over between states.");
  s.number("prior_sigma_velocity_mps", &S::prior_sigma_velocity_mps, "m/s", {1e-6, 1000},
           "Standard deviation of the velocity before the first scan, about zero.");
  s.number("prior_sigma_bias_acc_mps2", &S::prior_sigma_bias_acc_mps2, "m/s2", {1e-9, 100},
           "Standard deviation of the accelerometer's bias before the first scan.");
  s.number("prior_sigma_bias_gyro_radps", &S::prior_sigma_bias_gyro_radps, "rad/s", {1e-9, 10},
           "Standard deviation of the gyroscope's bias before the first scan.");
  s.number("prior_sigma_gravity_direction_rad", &S::prior_sigma_gravity_direction_rad, "rad",
           {1e-9, 4}, "Standard deviation of the map's own tilt against gravity.");
  s.number("prior_sigma_gravity_magnitude", &S::prior_sigma_gravity_magnitude, "", {1e-9, 1},
           "Standard deviation of the strength of gravity, relative.");
  s.number("gravity_walk_sqrthz", &S::gravity_walk_sqrthz, "1/sqrt(Hz)", {1e-12, 1},
           "Random walk of the direction of gravity, a unit vector.");
  s.number("velocity_sigma_mps", &S::velocity_sigma_mps, "m/s", {1e-6, 1000},
           "Standard deviation of the mean velocity where no IMU data joins two states.");
  s.number("map_robust_width", &S::map_robust_width, "", {0.1, 1e6},
           "Width of the map factor's Huber kernel, in standard deviations.");
  s.number("odometry_robust_width", &S::odometry_robust_width, "", {0.1, 1e6},
           "Width of the odometry factor's Huber kernel, in standard deviations.");
  s.number("map_correlation_distance_m", &S::map_correlation_distance_m, "m", {1e-6, 1e6},
           "Way over which the errors that scans share (plane_bias_m, range_bias_m) fall to 1/e.");
  s.number("max_innovation_sigmas", &S::max_innovation_sigmas, "", {1, 1e6},
           "A match further from the prediction, in standard deviations of both, is refused.");
  s.count("believe_after_contradictions", &S::believe_after_contradictions, {1, 1000000},
          "Refused for that in a row, matches that agree among themselves are believed.");
  s.number("rematch_position_m", &S::rematch_position_m, "m", {0, 100},
           "Smoothing at the end associates a scan with the map anew if its pose moved further.");
  s.number("rematch_rotation_rad", &S::rematch_rotation_rad, "rad", {0, 4},
           "Likewise for its rotation.");
  s.count("max_rematch_rounds", &S::max_rematch_rounds, {0, 100},
          "How often it does so, and smooths again.");
  s.number("rematch_memory_mb", &S::rematch_memory_mb, "MB", {0, 1e6},
           "Thinned scans kept for that; beyond it only those that were refused or left a "
           "direction open.");
  s.count("max_start_attempts", &S::max_start_attempts, {1, 1000000},
          "Scans tried from the initial pose, or without one, before giving up.");
  s.number("start_search_interval_s", &S::start_search_interval_s, "s", {0, 3600},
           "After a search of the map that failed, until the next one.");
  s.number("start_position_holds_m", &S::start_position_holds_m, "m", {0, 1000},
           "Way from the first scan that an initial position without a heading outlasts.");
  s.count("start_confirmations", &S::start_confirmations, {0, 1000000},
          "Scans that must bear out a start found by search.");
  s.number("start_confirm_motion_m", &S::start_confirm_motion_m, "m", {0, 1000},
           "Way that must lie between that start and the last of them.");
  s.count("relocate_after_refusals", &S::relocate_after_refusals, {1, 1000000},
          "Map factors refused in a row before a start is searched anew.");
  s.number("coasting_after_s", &S::coasting_after_s, "s", {0, 3600},
           "A pose further from any map factor is flagged as coasting.");
  s.number("lost_sigma_position_m", &S::lost_sigma_position_m, "m", {1e-3, 1000},
           "A pose less certain than this is flagged as lost.");
  return std::move(s).rows();
}

}  // namespace paloc

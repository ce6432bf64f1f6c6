#pragma once

#include "paloc/core/imu_noise.h"
#include "paloc/core/smoother_settings.h"
#include "paloc/core/stillness_settings.h"

namespace paloc {

/// Settings of the trajectory generator.
struct EstimatorSettings {
  ImuNoise imu;
  SmootherSettings smoother;
  StillnessSettings stillness;

  double gravity_mps2 = 9.80665;  ///< local strength of gravity
  double max_imu_gap_s = 0.05;    ///< samples further apart are not integrated over

  // What is known before the first scan, as standard deviations.
  double prior_sigma_velocity_mps = 2.0;
  double prior_sigma_bias_acc_mps2 = 0.1;
  double prior_sigma_bias_gyro_radps = 0.01;
  double prior_sigma_gravity_direction_rad = 0.01;  ///< of the map's own tilt
  double prior_sigma_gravity_magnitude = 0.001;     ///< relative

  double gravity_walk_sqrthz = 1e-6;   ///< random walk of the gravity direction, 1/sqrt(Hz)
  double velocity_sigma_mps = 0.5;     ///< of the mean velocity where no IMU data joins two nodes
  double map_robust_width = 4.0;       ///< Huber's, of the map factor, in standard deviations
  double odometry_robust_width = 4.0;  ///< likewise of the odometry factor

  /// Way over which the errors that scans share fall to 1/e. Surfaces stay in view for longer, but
  /// this is as far as smoothing reaches. The covariances of the result know better (README).
  double map_correlation_distance_m = 2.0;

  // Smoothing at the end associates scans with the map anew whose poses moved further than this,
  // and smooths again, so many times at most.
  double rematch_position_m = 0.05;
  double rematch_rotation_rad = 0.01;
  int max_rematch_rounds = 3;
  /// Thinned scans kept for that; beyond it only those that were refused or left a direction open.
  double rematch_memory_mb = 1000;

  /// A match further from the prediction than so many standard deviations of both is refused...
  double max_innovation_sigmas = 6.0;
  int believe_after_contradictions = 10;  ///< ...until so many in a row agree among themselves

  int max_start_attempts = 50;           ///< scans tried from what is given before giving up
  double start_search_interval_s = 1.0;  ///< after a search that failed, until the next one
  double start_position_holds_m = 0.5;   ///< way from the first frame that an initial position
                                         ///< outlasts: which way it moves on cannot be told
  int start_confirmations = 5;           ///< scans that must bear out a start found by search
  double start_confirm_motion_m = 0.5;   ///< between that start and the last of them
  int relocate_after_refusals =
      10;                          ///< map factors refused in a row before a start is searched anew
  double coasting_after_s = 0.35;  ///< a pose further from any map factor is flagged as coasting
  double lost_sigma_position_m = 0.5;  ///< a pose less certain than this is flagged as lost
};

}  // namespace paloc

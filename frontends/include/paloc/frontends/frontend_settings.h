#pragma once

#include <string>

#include "paloc/core/imu_noise.h"
#include "paloc/frontends/fast_lio_settings.h"
#include "paloc/frontends/icp_settings.h"
#include "paloc/frontends/lio_sam_settings.h"
#include "paloc/frontends/local_map_settings.h"

namespace paloc {

/// Settings of the front-ends; each reads those that concern it.
struct FrontendSettings {
  std::string lidar_label;     ///< sensor label of the scans; empty: the only LiDAR there is
  std::string imu_label;       ///< likewise of the IMU
  std::string odometry_label;  ///< likewise of the recorded odometry
  std::string odometry_file;  ///< `recorded`: a TUM file to use instead of the recording's odometry
  double min_range_m = 0.5;   ///< nearer returns are the platform itself
  double max_range_m = 120.0;
  bool deskew = true;  ///< undo the motion during a scan where points have times

  /// `recorded`, where the stream has no covariance: noise of the motion between two scans.
  double odometry_sigma_position_floor_m = 0.01;
  double odometry_sigma_position_ratio = 0.03;  ///< of the way since the last scan
  double odometry_sigma_rotation_floor_rad = 0.003;
  double odometry_sigma_rotation_ratio = 0.02;  ///< of the angle turned since the last scan
  double max_odometry_gap_s = 0.5;              ///< poses further apart are not interpolated
  double max_odometry_extrapolation_s =
      0.1;                              ///< how far beyond its last pose an odometry is carried on
  double max_odometry_speed_mps = 20;   ///< a faster step of the odometry is a jump, not a motion
  double max_odometry_rate_radps = 10;  ///< likewise of its rotation
  double max_imu_gap_s = 0.05;          ///< samples further apart are not integrated over
  double max_wait_s =
      1.0;  ///< recorded time for which a scan waits for the IMU and odometry at its end

  /// Of the IMU and the place, the same as the estimator's.
  ImuNoise imu_noise;
  double gravity_mps2 = 9.80665;

  LocalMapSettings local_map;
  FastLioSettings fast_lio;
  IcpSettings icp;
  LioSamSettings lio_sam;
};

}  // namespace paloc

#pragma once

#include <cstddef>
#include <string>

#include "paloc/core/types.h"

namespace paloc {

/// How the turning that a LiDAR, or a recorded odometry, has seen fits that of the gyroscope.
struct MotionComparison {
  std::string label;         ///< of the LiDAR or odometry
  bool of_odometry = false;  ///< of what another system made of the scans, not of the scans
  std::string imu_label;

  std::size_t steps = 0;    ///< intervals that were compared
  double turn_rms_rad = 0;  ///< of an interval: what is left if no turning is assumed
  /// The same with the gyroscope's turning taken out: as configured, and as fits best.
  double configured_rms_rad = 0, fitted_rms_rad = 0;
  bool turns = false;  ///< the body turns enough to tell anything
  bool fits = false;   ///< the gyroscope explains the turning in some way
  /// It does not, but about two axes: the place leaves the turn about the third open.
  bool one_turn_open = false;

  double gyro_scale = 1, gyro_scale_sigma = 0;  ///< true rate over reading
  Mat3 R_body_sensor = Mat3::Identity();        ///< as fits best; det = -1: left-handed
  Mat3 R_body_sensor_configured = Mat3::Identity();
  /// The turn, in the body frame, from the configured rotation to the one that fits, along
  /// directions that the motion tells (rad, zero along others), and the sigma of its length.
  Vec3 rotation_error_body = Vec3::Zero();
  double rotation_error_sigma_rad = 0;

  double offset_s = 0;  ///< the IMU's stamps are so much later than the other sensor's
  double offset_sigma_s = 0;
  bool offset_observable = false;  ///< the sigma is below 1 ms
  double scan_duration_s = 0;      ///< 0 for an odometry
};

}  // namespace paloc

#pragma once

#include <optional>
#include <vector>

#include "gyro_track.h"

namespace paloc {

/// How a sensor turned from one time to another, as it has seen it.
struct TurnStep {
  TimeNs from_ns = 0, to_ns = 0;
  /// What was seen is the mean over so long before each of the two times; 0: at these instants.
  TimeNs window_ns = 0;
  /// The points in that window were moved to its end by the gyroscope, with the rotation that the
  /// fit is given: only the rest of the motion is seen as a mean over the window.
  bool moved_by_gyro = false;
  Vec3 turn = Vec3::Zero();  ///< rotation vector (rad), in the sensor's frame
};

/// How a gyroscope's readings become the turns of another sensor.
struct TurnFit {
  Mat3 R_sensor_imu = Mat3::Identity();  ///< det = -1 if the IMU's axes are left-handed
  double scale = 1;     ///< true rate over reading: pi/180 if the readings are in deg/s
  double offset_s = 0;  ///< the IMU's stamps are so much later than the sensor's

  // What the turns say of these, given each other and a constant bias.
  double offset_sigma_s = 0;
  double scale_sigma = 0;
  Mat3 rotation_covariance = Mat3::Zero();  ///< rad2, of a small turn in the sensor's frame

  std::size_t steps = 0;
  double turn_rms_rad = 0;      ///< of the steps: what not turning at all would leave
  double residual_rms_rad = 0;  ///< what the fit leaves, robust

  /// Share of the square turning that is left unexplained, 0..1.
  double unexplained() const {
    return residual_rms_rad * residual_rms_rad / (turn_rms_rad * turn_rms_rad);
  }
};

/// Finds axes, scale and offset from nothing: Wahba's problem with a scale (Umeyama 1991) over a
/// grid of offsets, keeping to `R_sensor_imu` where the turns do not tell. Nothing if there are too
/// few turns for that.
std::optional<TurnFit> findTurnFit(const std::vector<TurnStep>& steps, const GyroTrack& gyro,
                                   const Mat3& R_sensor_imu);

/// Refines a fit by least squares over offset, axes, scale and the gyroscope's bias, with a robust
/// kernel. Steps moved by the gyroscope allow of one round: they hold for the fit that moved them.
TurnFit refineTurnFit(const std::vector<TurnStep>& steps, const GyroTrack& gyro, TurnFit fit,
                      int rounds = 5);

/// Root mean square of the turns (rad); 0 of none.
double turnRms(const std::vector<TurnStep>& steps);

/// Mean square of what a fit leaves of the turns as it stands (rad2, 3 x 3, in the sensor's frame),
/// outliers and all.
Mat3 turnResidual(const std::vector<TurnStep>& steps, const GyroTrack& gyro, const TurnFit& fit);

}  // namespace paloc

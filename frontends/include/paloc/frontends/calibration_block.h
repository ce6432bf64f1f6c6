#pragma once

#include "paloc/frontends/fast_lio_settings.h"
#include "paloc/frontends/lio_calibration.h"

namespace paloc {

/// The calibration as a part of a filter's state: its value, and its covariance with itself and
/// with the rest, all in the tangent spaces of LioState and LioCalibration. It does not change by
/// itself.
struct PALOC_EXPORT CalibrationBlock {
  using WithState = Eigen::Matrix<double, lio::kDim, lio_calibration::kDim>;

  /// What is not to be estimated is known exactly.
  explicit CalibrationBlock(const FastLioSettings& settings);

  CalibratedLioState with(const LioState& x) const { return {x, value, sensor}; }

  /// A map begins, with a scan at the end of which the state is x; `covariance` is the state's by
  /// all else. The map's frame hangs on the LiDAR: its pose is known, and the body's and gravity
  /// follow from it, wrong as the calibration is. (Had the first body's pose been taken as known
  /// instead, the map would confirm the wrong calibration that it was made with.) What a velocity
  /// that is not known makes of the time offset is added as if it were independent.
  void begin(const LioState& x, const SensorMotion& during_scan, LioMatrix& covariance);

  /// The state's errors are multiplied by F; `x` is the state before.
  void predict(const LioState& x, const LioMatrix& F);

  /// Covariance of state and calibration.
  CalibratedLioMatrix joint(const LioMatrix& covariance) const;
  /// Takes what an update made of both.
  void take(const LioCalibration& updated, const CalibratedLioMatrix& joint);

  /// The time offset less what it says here is put into stamps from now on: at most `most_s`.
  void takeTimeOffset(double most_s);
  double imuLateS() const { return applied_s + value.imu_late_s; }

  LioCalibration value;
  CalibrationMatrix covariance = CalibrationMatrix::Zero();
  WithState with_state = WithState::Zero();  ///< E[error of the state . that of the calibration]
  SensorMotion sensor;                       ///< during the last scan
  int scans = 0;                             ///< since the map began
  double applied_s = 0;                      ///< of the time offset, in the stamps already

  // Before the last prediction: E[error of the calibration now . that of the pose then], and the
  // derivative of the LiDAR's pose by the calibration.
  Eigen::Matrix<double, lio_calibration::kDim, 6> cross_0 =
      Eigen::Matrix<double, lio_calibration::kDim, 6>::Zero();
  Eigen::Matrix<double, 6, lio_calibration::kDim> lidar_0 =
      Eigen::Matrix<double, 6, lio_calibration::kDim>::Zero();
};

}  // namespace paloc

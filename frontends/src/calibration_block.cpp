#include "paloc/frontends/calibration_block.h"

#include <algorithm>

namespace paloc {

CalibrationBlock::CalibrationBlock(const FastLioSettings& settings) {
  const auto set = [this](int at, int size, double sigma) {
    covariance.diagonal().segment(at, size).setConstant(sigma * sigma);
  };
  if (settings.estimate_extrinsic) {
    set(lio_calibration::kRotation, 3, settings.sigma_extrinsic_rotation_rad);
    set(lio_calibration::kPosition, 3, settings.sigma_extrinsic_position_m);
  }
  if (settings.estimate_time_offset) {
    set(lio_calibration::kTimeOffset, 1, settings.sigma_time_offset_s);
  }
}

void CalibrationBlock::begin(const LioState& x, const SensorMotion& during_scan,
                             LioMatrix& of_state) {
  sensor = during_scan;
  scans = 0;
  const WithState B = lidarByCalibration(with(x));
  const double offset_variance =
      covariance(lio_calibration::kTimeOffset, lio_calibration::kTimeOffset);
  of_state += B * covariance * B.transpose();
  of_state.diagonal().segment<3>(lio::kPosition) +=
      offset_variance * of_state.diagonal().segment<3>(lio::kVelocity);
  with_state = -B * covariance;
}

void CalibrationBlock::predict(const LioState& x, const LioMatrix& F) {
  cross_0 = with_state.topRows<6>().transpose();
  lidar_0 = lidarByCalibration(with(x)).topRows<6>();
  with_state = (F * with_state).eval();
}

CalibratedLioMatrix CalibrationBlock::joint(const LioMatrix& of_state) const {
  CalibratedLioMatrix joint;
  joint << of_state, with_state, with_state.transpose(), covariance;
  return joint;
}

void CalibrationBlock::take(const LioCalibration& updated, const CalibratedLioMatrix& joint) {
  value = updated;
  covariance = joint.bottomRightCorner<lio_calibration::kDim, lio_calibration::kDim>();
  with_state = joint.topRightCorner<lio::kDim, lio_calibration::kDim>();
}

void CalibrationBlock::takeTimeOffset(double most_s) {
  const double taken_s = std::clamp(value.imu_late_s, -most_s, most_s);
  value.imu_late_s -= taken_s;
  applied_s += taken_s;
}

}  // namespace paloc

#include "paloc/frontends/lio_calibration.h"

#include "lio_update.h"
#include "paloc/core/so3.h"

namespace paloc {
namespace {

using lio_calibration::kPosition;
using lio_calibration::kRotation;
using lio_calibration::kTimeOffset;

}  // namespace

SensorMotion::SensorMotion(const FreeFallScan& scan, const Vec3& sensor)
    : sensor_body(sensor),
      rate_body(scan.meanRate()),
      force_body(scan.meanForce()),
      R_end_middle(scan.bodyAt(0.5 * scan.durationS()).rotation),
      lasts(scan.durationS() > 0) {}

CalibratedLioState boxplus(const CalibratedLioState& s, const CalibratedLioVector& delta) {
  const CalibrationVector d = delta.tail<lio_calibration::kDim>();
  CalibratedLioState moved = s;
  moved.x = boxplus(s.x, LioVector(delta.head<lio::kDim>() - lidarByCalibration(s) * d));
  moved.calibration.R = s.calibration.R * so3::exp(d.segment<3>(kRotation));
  moved.calibration.moved_body += d.segment<3>(kPosition);
  moved.calibration.imu_late_s += d[kTimeOffset];
  return moved;
}

CalibratedLioVector boxminus(const CalibratedLioState& to, const CalibratedLioState& from) {
  const LioCalibration &a = to.calibration, &b = from.calibration;
  CalibrationVector d;
  d << so3::log(b.R.transpose() * a.R), a.moved_body - b.moved_body, a.imu_late_s - b.imu_late_s;
  CalibratedLioVector delta;
  delta << boxminus(to.x, from.x) + lidarByCalibration(from) * d, d;
  return delta;
}

// A point's place in the body moves by R_c w x (q - l) + t, l that of the sensor: a turn by R_c w
// about the sensor, and a shift by t. Later by dt, the point moves with the body. Gravity turns
// with the LiDAR: it is told in the body's frame.
Eigen::Matrix<double, lio::kDim, lio_calibration::kDim> lidarByCalibration(
    const CalibratedLioState& s) {
  const Mat3& R = s.x.T_odom_body.rotation;
  const Vec3 sensor = s.sensor.sensor_body + s.calibration.moved_body;
  const Mat3 turned = s.sensor.R_end_middle * s.calibration.R;
  Eigen::Matrix<double, lio::kDim, lio_calibration::kDim> B;
  B.setZero();
  B.block<3, 3>(lio::kPosition, kRotation) = R * so3::hat(sensor) * turned;
  B.block<3, 3>(lio::kRotation, kRotation) = turned;
  B.block<3, 3>(lio::kPosition, kPosition) = R;
  if (s.sensor.lasts) {
    B.block<3, 1>(lio::kPosition, kTimeOffset) = s.x.v_odom;
    B.block<3, 1>(lio::kRotation, kTimeOffset) = s.sensor.rate_body;
  }
  B.middleRows<2>(lio::kGravity) =
      tangentBasis(s.x.gravity_odom).transpose() * R * B.middleRows<3>(lio::kRotation);
  return B;
}

CalibratedLioMatrix toLidar(const CalibratedLioState& s, double sign) {
  CalibratedLioMatrix S = CalibratedLioMatrix::Identity();
  S.topRightCorner<lio::kDim, lio_calibration::kDim>() = sign * lidarByCalibration(s);
  return S;
}

// tau before the end, the sensor lies R (l - tau omega x l) from the body, and a shift in the body
// is turned by as much: as if the velocity were another. So it is where the body speeds up.
Eigen::Matrix<double, 9, CalibratedLioState::kDim> calibratedToMeasured(
    const CalibratedLioState& s) {
  const Mat3& R = s.x.T_odom_body.rotation;
  const Vec3 sensor = s.sensor.sensor_body + s.calibration.moved_body;
  Eigen::Matrix<double, 9, CalibratedLioState::kDim> derivative;
  derivative << lioToMeasured(s.x), Eigen::Matrix<double, 9, lio_calibration::kDim>::Zero();
  derivative.block<3, 3>(6, lio::kDim + kRotation) =
      R * so3::hat(s.sensor.rate_body.cross(sensor)) * s.sensor.R_end_middle * s.calibration.R;
  derivative.block<3, 3>(6, lio::kDim + kPosition) = R * so3::hat(s.sensor.rate_body);
  if (s.sensor.lasts) {
    derivative.block<3, 1>(6, lio::kDim + kTimeOffset) = R * s.sensor.force_body + s.x.gravity_odom;
  }
  return derivative;
}

}  // namespace paloc

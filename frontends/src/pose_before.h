#pragma once

#include "paloc/frontends/calibration_block.h"

namespace paloc {

/// The pose before the last prediction, with its covariance and E[error of state and calibration .
/// error of that pose].
struct PoseBefore {
  using Cross = Eigen::Matrix<double, CalibratedLioState::kDim, 6>;

  Pose pose;
  Mat6 covariance = Mat6::Zero();
  Cross cross = Cross::Zero();
};

/// The pose before of the LiDAR, as an error of the body's: what is known of it does not hang on
/// the calibration's error. `covariance` is that of state and calibration.
inline PoseBefore ofLidar(const PoseBefore& body, const CalibrationBlock& calibration,
                          const CalibratedLioMatrix& covariance) {
  const auto& B = calibration.lidar_0;
  const Mat6 shared = B * body.cross.bottomRows<lio_calibration::kDim>();
  PoseBefore lidar = body;
  lidar.covariance += shared + shared.transpose() + B * calibration.covariance * B.transpose();
  lidar.cross += covariance.rightCols<lio_calibration::kDim>() * B.transpose();
  return lidar;
}

/// Back to the body's, with the calibration as it is now known, by `change` another: the body was
/// elsewhere, then, too. Without that, the motion since would contain the change.
inline PoseBefore ofBody(const PoseBefore& lidar, const CalibrationBlock& calibration,
                         const CalibrationVector& change, const CalibratedLioMatrix& covariance) {
  const auto& B = calibration.lidar_0;
  const Mat6 shared = B * lidar.cross.bottomRows<lio_calibration::kDim>();
  PoseBefore body = lidar;
  body.pose = boxplus(lidar.pose, Vec6(-B * change));
  body.covariance += B * calibration.covariance * B.transpose() - shared - shared.transpose();
  body.cross -= covariance.rightCols<lio_calibration::kDim>() * B.transpose();
  return body;
}

}  // namespace paloc

#include "motion_covariance.h"

#include <Eigen/QR>

namespace paloc {
namespace {

constexpr double kMovesThePose = 0.1;  // of a direction of unit length

}  // namespace

// With e the error of the pose now and e_0 that of the one before, in the tangent spaces of the
// poses: the error of the motion's position is R_0^T (e_p - e_0p) + hat(t) e_0r, t the motion's
// position, and that of its rotation e_r - R^T e_0r, R the motion's rotation.
Mat6 covarianceOfMotion(const Pose& T_0, const Pose& T_1, const Mat6& covariance_0,
                        const Mat6& covariance_1, const Mat6& cross) {
  const Pose motion = T_0.inverse() * T_1;
  const Mat3 R_0 = T_0.rotation;
  Mat6 now = Mat6::Zero(), before = Mat6::Zero();
  now.block<3, 3>(0, 0) = R_0.transpose();
  now.block<3, 3>(3, 3) = Mat3::Identity();
  before.block<3, 3>(0, 0) = -R_0.transpose();
  before.block<3, 3>(0, 3) = so3::hat(motion.position);
  before.block<3, 3>(3, 3) = -motion.rotation.transpose();
  const Mat6 shared = now * cross * before.transpose();
  const Mat6 covariance = now * covariance_1 * now.transpose() +
                          before * covariance_0 * before.transpose() + shared + shared.transpose();
  return 0.5 * (covariance + covariance.transpose());
}

Mat6 openDirectionsOfMotion(const Pose& T_0, const Eigen::Matrix<double, 6, Eigen::Dynamic>& open) {
  Mat6 projector = Mat6::Zero();
  Eigen::MatrixXd directions(6, 0);
  for (Eigen::Index k = 0; k < open.cols(); ++k) {
    if (open.col(k).norm() < kMovesThePose) continue;
    directions.conservativeResize(Eigen::NoChange, directions.cols() + 1);
    directions.rightCols<1>() << T_0.rotation.transpose() * open.col(k).head<3>(),
        open.col(k).tail<3>();
  }
  if (directions.cols() == 0) return projector;
  Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> range;
  range.setThreshold(kMovesThePose);
  range.compute(directions);
  const Eigen::MatrixXd found = directions * range.pseudoInverse();
  projector = 0.5 * (found + found.transpose());
  return projector;
}

}  // namespace paloc

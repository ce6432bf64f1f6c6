#include "paloc/core/mrpt_pose.h"

#include <Eigen/LU>
#include <cmath>

namespace paloc {
namespace {

// d(theta_body) = E d(yaw, pitch, roll) for R = Rz(yaw) Ry(pitch) Rx(roll).
Mat3 bodyRateOfEulerAngles(double pitch, double roll) {
  Mat3 e;
  e << -std::sin(pitch), 0, 1,                              //
      std::cos(pitch) * std::sin(roll), std::cos(roll), 0,  //
      std::cos(pitch) * std::cos(roll), -std::sin(roll), 0;
  return e;
}

Mat6 tangentOfMrptOrder(const mrpt::poses::CPose3D& pose) {
  Mat6 j = Mat6::Zero();
  j.topLeftCorner<3, 3>().setIdentity();
  j.bottomRightCorner<3, 3>() = bodyRateOfEulerAngles(pose.pitch(), pose.roll());
  return j;
}

}  // namespace

Pose fromMrpt(const mrpt::poses::CPose3D& pose) {
  Pose result;
  result.position = Vec3(pose.x(), pose.y(), pose.z());
  const auto& r = pose.getRotationMatrix();
  for (int row = 0; row < 3; ++row) {
    for (int col = 0; col < 3; ++col) result.rotation(row, col) = r(row, col);
  }
  return result;
}

mrpt::poses::CPose3D toMrpt(const Pose& pose) {
  mrpt::math::CMatrixDouble33 r;
  for (int row = 0; row < 3; ++row) {
    for (int col = 0; col < 3; ++col) r(row, col) = pose.rotation(row, col);
  }
  mrpt::math::CVectorFixedDouble<3> t;
  for (int row = 0; row < 3; ++row) t[row] = pose.position[row];
  return mrpt::poses::CPose3D(r, t);
}

Mat6 tangentCovariance(const mrpt::poses::CPose3DPDFGaussian& pose) {
  Mat6 covariance;
  for (int row = 0; row < 6; ++row) {
    for (int col = 0; col < 6; ++col) covariance(row, col) = pose.cov(row, col);
  }
  const Mat6 j = tangentOfMrptOrder(pose.mean);
  return j * covariance * j.transpose();
}

mrpt::poses::CPose3DPDFGaussian toMrpt(const Pose& pose, const Mat6& covariance) {
  mrpt::poses::CPose3DPDFGaussian result;
  result.mean = toMrpt(pose);
  const Mat6 j_inverse = tangentOfMrptOrder(result.mean).inverse();
  const Mat6 cov = j_inverse * covariance * j_inverse.transpose();
  for (int row = 0; row < 6; ++row) {
    for (int col = 0; col < 6; ++col) result.cov(row, col) = cov(row, col);
  }
  return result;
}

}  // namespace paloc

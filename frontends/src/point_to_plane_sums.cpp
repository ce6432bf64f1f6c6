#include "paloc/frontends/point_to_plane_sums.h"

#include <Eigen/Eigenvalues>
#include <cmath>

namespace paloc {
namespace {

constexpr double kStandsOut = 10;  // information over that of noise, below: nothing

}  // namespace

// G^T (1 - n n^T) G = G^T G - j j^T, with G = [1, -hat(lever), -tau].
void PointToPlaneSums::addNormalNoise(const PointToPlane& row, double weight,
                                      double normal_variance, double ageing) {
  const double w = weight * normal_variance;
  Eigen::Matrix<double, 3, 9> G;
  G << Mat3::Identity(), -so3::hat(row.lever), -ageing * row.age_s * Mat3::Identity();
  const Vec9 j = jacobianOf(row, ageing);
  information.noalias() += w * (G.transpose() * G);
  information.noalias() -= (w * j) * j.transpose();
}

void InformativePart::addOpen(const Vec9& direction) {
  const Vec9 rest = direction - open_ * (open_.transpose() * direction).eval();
  if (open_.cols() == 9 || !(rest.norm() > 1e-6)) return;
  open_.conservativeResize(Eigen::NoChange, open_.cols() + 1);
  open_.col(open_.cols() - 1) = rest.normalized();
}

// `floor` is added to the noise, so that it can be inverted.
void InformativePart::findOpen(const Mat9& information, const Mat9& noise, int at, double floor) {
  const Mat3 n = noise.block<3, 3>(at, at) + floor * Mat3::Identity();
  const Eigen::GeneralizedSelfAdjointEigenSolver<Mat3> solver(information.block<3, 3>(at, at), n);
  for (int i = 0; i < 3; ++i) {
    if (solver.eigenvalues()[i] >= kStandsOut) continue;
    Vec9 direction = Vec9::Zero();
    direction.segment<3>(at) = solver.eigenvectors().col(i).normalized();
    addOpen(direction);
    // A scan that does not see a displacement does not see the velocity along it either.
    if (at == 0) addOpen((Vec9() << Vec6::Zero(), direction.head<3>()).finished());
  }
}

InformativePart::InformativePart(const Mat9& information, const Mat9& noise) {
  const double floor = 1e-9 * noise.diagonal().maxCoeff() + 1e-12;
  findOpen(information, noise, 0, floor);
  findOpen(information, noise, 3, floor);
  projector_ = Mat9::Identity() - open_ * open_.transpose();
  const Mat9 n = projector_ * noise * projector_ + floor * Mat9::Identity();
  const Mat9 known = projector_ * information * projector_;
  const Eigen::GeneralizedSelfAdjointEigenSolver<Mat9> solver(known, n);
  const Mat9& v = solver.eigenvectors();  // v^T n v = 1
  const Vec9 root =
      (1 - kStandsOut * solver.eigenvalues().array().max(1e-12).inverse()).max(0).sqrt();
  root_ = n * v * root.asDiagonal() * v.transpose();
}

void InformativePart::apply(PointToPlaneSums& sums) const {
  const Mat9 left = root_ * projector_;
  const Mat9 scaled = left * sums.information * left.transpose();
  sums.information = 0.5 * (scaled + scaled.transpose());
  sums.gradient = root_ * (left * sums.gradient).eval();
}

}  // namespace paloc

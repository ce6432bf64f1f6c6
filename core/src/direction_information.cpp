#include "paloc/core/direction_information.h"

#include <Eigen/Eigenvalues>
#include <algorithm>

namespace paloc {

Mat3 pseudoInverse(const Mat3& block) {
  const Eigen::SelfAdjointEigenSolver<Mat3> solver(block);
  const double smallest = 1e-12 * std::max(solver.eigenvalues()[2], 1e-300);
  Vec3 inverse = Vec3::Zero();
  for (int i = 0; i < 3; ++i) {
    if (solver.eigenvalues()[i] > smallest) inverse[i] = 1 / solver.eigenvalues()[i];
  }
  return solver.eigenvectors() * inverse.asDiagonal() * solver.eigenvectors().transpose();
}

Mat3 schurComplement(const Mat6& information, DirectionKind own) {
  const int at = static_cast<int>(own), other = 3 - at;
  const Mat3 cross = information.block<3, 3>(other, at);
  const Mat3 schur =
      information.block<3, 3>(at, at) -
      cross.transpose() * pseudoInverse(information.block<3, 3>(other, other)) * cross;
  return 0.5 * (schur + schur.transpose());
}

void scaleDirection(Mat6& information, DirectionKind own, const Vec3& axis, double factor) {
  const Vec3 x = schurComplement(information, own) * axis;
  const double along = axis.dot(x);
  if (along <= 0) return;
  const int at = static_cast<int>(own);
  information.block<3, 3>(at, at) -= ((1 - factor) / along) * x * x.transpose();
}

void cutToKnown(Mat6& information, Mat6& spread) {
  using Square = Eigen::Matrix<double, 6, 6>;
  const Eigen::SelfAdjointEigenSolver<Square> solver(information);
  const Vec6 eigenvalues = solver.eigenvalues().cwiseMax(0.0);
  const Square& vectors = solver.eigenvectors();
  const double smallest = 1e-9 * eigenvalues[5];
  if (eigenvalues[0] > smallest) return;
  information = vectors * eigenvalues.asDiagonal() * vectors.transpose();
  const Vec6 known = (eigenvalues.array() > smallest).cast<double>();
  const Square projector = vectors * known.asDiagonal() * vectors.transpose();
  spread = (projector * spread * projector).eval();
}

}  // namespace paloc

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

namespace {

using Square = Eigen::Matrix<double, 6, 6>;
using Solver = Eigen::SelfAdjointEigenSolver<Square>;

constexpr double kKnown = 1e-9;  // of the largest eigenvalue

Square projectorOf(const Solver& solver) {
  const Vec6& eigenvalues = solver.eigenvalues();
  const Vec6 known = (eigenvalues.array() > kKnown * eigenvalues[5]).cast<double>();
  return solver.eigenvectors() * known.asDiagonal() * solver.eigenvectors().transpose();
}

}  // namespace

void cutToKnown(Mat6& information, Mat6& spread) {
  const Solver solver(information);
  const Vec6 eigenvalues = solver.eigenvalues().cwiseMax(0.0);
  if (eigenvalues[0] > kKnown * eigenvalues[5]) return;
  const Square& vectors = solver.eigenvectors();
  information = vectors * eigenvalues.asDiagonal() * vectors.transpose();
  const Square projector = projectorOf(solver);
  spread = (projector * spread * projector).eval();
}

Mat6 projectorOntoKnown(const Mat6& information) { return projectorOf(Solver(information)); }

}  // namespace paloc

#include "paloc/frontends/point_to_plane_sums.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>

namespace paloc {
namespace {

constexpr double kStandsOut = 10;  // information over that of noise, below: nothing

}  // namespace

// With G = [B, -tau B, -s B], B = [1, -hat(lever)], of which the velocity's columns may be fewer:
// G^T (1 - n n^T) G is made of multiples of B^T B - j j^T, j the first six of jacobianOf().
template <int N>
void PointToPlaneSums<N>::addNormalNoise(const PointToPlane& row, double weight,
                                         double normal_variance, double ageing) {
  Eigen::Matrix<double, 3, 6> B;
  B << Mat3::Identity(), -so3::hat(row.lever);
  const Vec6 j = jacobianOf<N>(row, ageing).template head<6>();
  addMultiples(weight * normal_variance * (B.transpose() * B - j * j.transpose()), row, ageing);
}

template <int N>
void PointToPlaneSums<N>::add(const PointToPlane& row, double weight, double ageing) {
  const Vector j = jacobianOf<N>(row, ageing);
  const Vec6 first = j.template head<6>();
  addMultiples((weight * first) * first.transpose(), row, ageing);
  gradient += (weight * row.residual) * j;
}

// The information of position and rotation, and that of their derivatives.
template <int N>
void PointToPlaneSums<N>::addMultiples(const Mat6& of_pose, const PointToPlane& row,
                                       double ageing) {
  const double of_velocity = -ageing * row.age_s, of_bend = -ageing * row.sag_s2;
  information.template topLeftCorner<6, 6>() += of_pose;
  if constexpr (N == 9) {
    information.template topRightCorner<6, 3>() += of_velocity * of_pose.leftCols<3>();
    information.template bottomLeftCorner<3, 6>() += of_velocity * of_pose.topRows<3>();
    information.template bottomRightCorner<3, 3>() +=
        of_velocity * of_velocity * of_pose.topLeftCorner<3, 3>();
  } else {
    const std::array<double, 3> factors{1, of_velocity, of_bend};
    for (int a = 0; a < 3; ++a) {
      for (int b = 0; b < 3; ++b) {
        if (a + b == 0) continue;
        information.template block<6, 6>(6 * a, 6 * b) +=
            factors[static_cast<std::size_t>(a)] * factors[static_cast<std::size_t>(b)] * of_pose;
      }
    }
  }
}

template <int N>
void InformativePart<N>::addOpen(const Vector& direction) {
  const Vector rest = direction - open_ * (open_.transpose() * direction).eval();
  constexpr double kNew = 1e-3;  // less is the rounding of one that is known as open already
  if (open_.cols() == N || !(rest.norm() > kNew)) return;
  open_.conservativeResize(Eigen::NoChange, open_.cols() + 1);
  open_.col(open_.cols() - 1) = rest.normalized();
}

// Of the block of `Size` unknowns from `at` on. `floor` is added to the noise, so that it can be
// inverted.
template <int N>
template <int Size>
void InformativePart<N>::findOpen(const Matrix& information, const Matrix& noise, int at,
                                  double floor) {
  using Block = Eigen::Matrix<double, Size, Size>;
  const Block n = noise.template block<Size, Size>(at, at) + floor * Block::Identity();
  const Block known = information.template block<Size, Size>(at, at);
  const Eigen::GeneralizedSelfAdjointEigenSolver<Block> solver(known, n);
  for (int i = 0; i < Size; ++i) {
    if (solver.eigenvalues()[i] >= kStandsOut) continue;
    const Eigen::Matrix<double, Size, 1> axis = solver.eigenvectors().col(i).normalized();
    // A scan that does not see a displacement does not see the velocity along it either. Where the
    // scan's rotation is taken from a gyroscope, it sees the velocity no better than the rate.
    for (int derivative = at; derivative < N; derivative += 6) {
      const int known_by_scan = std::min(Size, N - derivative);
      Vector direction = Vector::Zero();
      direction.segment(derivative, known_by_scan) = axis.head(known_by_scan);
      addOpen(direction);
    }
  }
}

template <int N>
InformativePart<N>::InformativePart(const Matrix& information, const Matrix& noise) {
  const double floor = 1e-9 * noise.diagonal().maxCoeff() + 1e-12;
  findOpen<3>(information, noise, 0, floor);
  findOpen<3>(information, noise, 3, floor);
  projector_ = Matrix::Identity() - open_ * open_.transpose();
  findOpen<6>(projector_ * information * projector_, projector_ * noise * projector_, 0, floor);
  projector_ = Matrix::Identity() - open_ * open_.transpose();
  const Matrix n = projector_ * noise * projector_ + floor * Matrix::Identity();
  const Matrix known = projector_ * information * projector_;
  const Eigen::GeneralizedSelfAdjointEigenSolver<Matrix> solver(known, n);
  const Matrix& v = solver.eigenvectors();  // v^T n v = 1
  const Vector root =
      (1 - kStandsOut * solver.eigenvalues().array().max(1e-12).inverse()).max(0).sqrt();
  root_ = n * v * root.asDiagonal() * v.transpose();
}

template <int N>
void InformativePart<N>::apply(PointToPlaneSums<N>& sums) const {
  const Matrix left = root_ * projector_;
  const Matrix scaled = left * sums.information * left.transpose();
  sums.information = 0.5 * (scaled + scaled.transpose());
  sums.gradient = root_ * (left * sums.gradient).eval();
}

template struct PointToPlaneSums<9>;
template struct PointToPlaneSums<18>;
template class InformativePart<9>;
template class InformativePart<18>;

}  // namespace paloc

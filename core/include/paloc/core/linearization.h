#pragma once

#include "paloc/core/state.h"

namespace paloc {

/// A factor on one node, linearized: |residual + jacobian * delta|^2 with everything whitened,
/// delta in the tangent space of State.
template <int M>
struct NodeLinearization {
  static constexpr int kRows = M;
  Eigen::Matrix<double, M, 1> residual = Eigen::Matrix<double, M, 1>::Zero();
  Eigen::Matrix<double, M, tangent::kDim> jacobian =
      Eigen::Matrix<double, M, tangent::kDim>::Zero();
};

/// A factor between two neighbouring nodes i (earlier) and j, linearized and whitened.
template <int M>
struct EdgeLinearization {
  static constexpr int kRows = M;
  Eigen::Matrix<double, M, 1> residual = Eigen::Matrix<double, M, 1>::Zero();
  Eigen::Matrix<double, M, tangent::kDim> jacobian_i =
      Eigen::Matrix<double, M, tangent::kDim>::Zero();
  Eigen::Matrix<double, M, tangent::kDim> jacobian_j =
      Eigen::Matrix<double, M, tangent::kDim>::Zero();
};

namespace detail {
template <class Derived, class Block>
void multiplyFromLeft(const Eigen::MatrixBase<Derived>& matrix, Block&& block) {
  block = matrix.lazyProduct(block).eval();
}
template <class Derived, class Block>
void multiplyFromLeft(const Eigen::DiagonalBase<Derived>& diagonal, Block&& block) {
  block = diagonal * block;
}

// By blocks of three columns: most of a factor's Jacobian is zero.
template <class Whitening, int M>
void whitenColumns(const Whitening& sqrt_information,
                   Eigen::Matrix<double, M, tangent::kDim>& jacobian) {
  for (int offset = 0; offset < tangent::kDim; offset += 3) {
    auto block = jacobian.template middleCols<3>(offset);
    if (!block.isZero(0)) multiplyFromLeft(sqrt_information, block);
  }
}
}  // namespace detail

/// Whitens a factor's residual and Jacobian by the square root W of its information (W^T W).
template <int M, class Whitening>
void whiten(const Whitening& sqrt_information, NodeLinearization<M>& l) {
  l.residual = (sqrt_information * l.residual).eval();
  detail::whitenColumns(sqrt_information, l.jacobian);
}

template <int M, class Whitening>
void whiten(const Whitening& sqrt_information, EdgeLinearization<M>& l) {
  l.residual = (sqrt_information * l.residual).eval();
  detail::whitenColumns(sqrt_information, l.jacobian_i);
  detail::whitenColumns(sqrt_information, l.jacobian_j);
}

}  // namespace paloc

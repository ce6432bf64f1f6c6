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

/// Whitens a factor's residual and Jacobian by the square root W of its information (W^T W).
template <int M, class Whitening>
void whiten(const Whitening& sqrt_information, NodeLinearization<M>& l) {
  l.residual = (sqrt_information * l.residual).eval();
  l.jacobian = (sqrt_information * l.jacobian).eval();
}

template <int M, class Whitening>
void whiten(const Whitening& sqrt_information, EdgeLinearization<M>& l) {
  l.residual = (sqrt_information * l.residual).eval();
  l.jacobian_i = (sqrt_information * l.jacobian_i).eval();
  l.jacobian_j = (sqrt_information * l.jacobian_j).eval();
}

}  // namespace paloc

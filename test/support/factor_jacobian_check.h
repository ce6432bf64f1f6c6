#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <array>

#include "paloc/core/linearization.h"

namespace paloc {

template <int M>
const auto& jacobianOf(const NodeLinearization<M>& l, std::size_t) {
  return l.jacobian;
}
template <int M>
const auto& jacobianOf(const EdgeLinearization<M>& l, std::size_t node) {
  return node == 0 ? l.jacobian_i : l.jacobian_j;
}

/// Checks the analytic Jacobians of any factor, on one node or on the edge between two, against
/// central differences on the tangent space of its states. Errors are relative to the largest entry
/// of the Jacobian's row, or to `row_scale` (whitened) where the row is smaller.
template <class Factor, class... States>
void expectJacobiansMatchDifferences(const Factor& factor, const States&... states) {
  constexpr double kStep = 1e-5, kTolerance = 2e-7;
  std::array<State, sizeof...(States)> x{states...};
  const auto linearize = [&] {
    return std::apply([&](const auto&... s) { return factor.linearize(s...); }, x);
  };
  const auto analytic = linearize();
  for (std::size_t node = 0; node < x.size(); ++node) {
    const auto& jacobian = jacobianOf(analytic, node);
    std::remove_cvref_t<decltype(jacobian)> numeric;
    const State here = x[node];
    for (int k = 0; k < tangent::kDim; ++k) {
      x[node] = boxplus(here, StateVector::Unit(k) * kStep);
      const auto ahead = linearize().residual;
      x[node] = boxplus(here, StateVector::Unit(k) * -kStep);
      numeric.col(k) = (ahead - linearize().residual) / (2 * kStep);
    }
    x[node] = here;
    for (int row = 0; row < numeric.rows(); ++row) {
      const double scale = std::max(1e-6, numeric.row(row).cwiseAbs().maxCoeff()) +
                           std::abs(analytic.residual[row]);  // its rounding limits differences
      const double error = (jacobian.row(row) - numeric.row(row)).cwiseAbs().maxCoeff();
      ASSERT_LE(error, kTolerance * scale) << "node " << node << ", row " << row << "\nanalytic\n"
                                           << jacobian.row(row) << "\nnumeric\n"
                                           << numeric.row(row);
    }
  }
}

}  // namespace paloc

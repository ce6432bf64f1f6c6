#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>

#include "paloc/core/types.h"

namespace paloc {

/// Calls visit(cell) for the cells of a grid of edge 1 that the line from `from` to `to` passes, in
/// order, the first and the last included, until it returns false. After J. Amanatides and A. Woo,
/// "A Fast Voxel Traversal Algorithm for Ray Tracing" (1987).
template <typename Visit>
void walkCells(const Vec3& from, const Vec3& to, const Visit& visit) {
  std::array<int, 3> cell{}, step{};
  std::array<double, 3> next{}, delta{};
  int left = 0;  // borders that are still to be crossed
  for (std::size_t a = 0; a < 3; ++a) {
    const auto axis = static_cast<Eigen::Index>(a);
    const double floor = std::floor(from[axis]);
    const double along = to[axis] - from[axis];
    cell[a] = static_cast<int>(floor);
    left += std::abs(static_cast<int>(std::floor(to[axis])) - cell[a]);
    step[a] = along > 0 ? 1 : -1;
    delta[a] = std::numeric_limits<double>::infinity();
    next[a] = delta[a];
    if (along != 0) {
      delta[a] = 1 / std::abs(along);
      next[a] = delta[a] * (along > 0 ? floor + 1 - from[axis] : from[axis] - floor);
    }
  }
  while (visit(cell) && left-- > 0) {
    const std::size_t a =
        next[0] < next[1] ? (next[0] < next[2] ? 0 : 2) : (next[1] < next[2] ? 1 : 2);
    cell[a] += step[a];
    next[a] += delta[a];
  }
}

}  // namespace paloc

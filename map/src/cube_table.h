#pragma once

#include <tbb/task_arena.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "paloc/core/types.h"
#include "point_block.h"
#include "raw_array.h"
#include "voxel_key.h"

namespace paloc {

/// Where the points of each cube of space lie in an array. It is meant for points along a Hilbert
/// curve, of which those of one cube follow each other; of any others it holds more entries. The
/// cubes are so large that they hold a dozen points on average.
class CubeTable {
 public:
  /// A number of points that follow each other in one cube.
  struct Run {
    std::uint64_t cube;
    std::uint32_t first, count;
  };
  using Cube = std::array<std::uint32_t, 3>;  ///< numbers of a cube along x, y, z

  CubeTable() = default;
  /// The curve goes through voxels of `voxel_m` of the grid in whose first voxel `low` lies, which
  /// no point lies below.
  CubeTable(const PointBlock* blocks, std::size_t points, const Point3f& low, double voxel_m,
            tbb::task_arena& arena);

  double edge() const { return edge_m_; }  ///< of a cube (m)
  std::size_t bytes() const { return slots_.size() * sizeof(Run); }

  Cube cubeOf(const Point3f& p) const { return cubeOf(p, 0); }
  /// Of the point moved by `by_m` along each axis.
  Cube cubeOf(const Point3f& p, double by_m) const {
    const auto moved = [by_m](float value) { return static_cast<double>(value) + by_m; };
    return {numberOf(moved(p.x), low_[0]), numberOf(moved(p.y), low_[1]),
            numberOf(moved(p.z), low_[2])};
  }
  /// Squares of the distances along each axis (m2) from a point to those cubes beside its own that
  /// begin with `lowest`: to the one below where that is lower than its own, else to the one above.
  std::array<double, 3> distancesSq(const Point3f& p, const Cube& lowest, const Cube& own) const {
    const std::array<float, 3> at{p.x, p.y, p.z};
    std::array<double, 3> distances_sq{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double begin = low_[axis] + edge_m_ * own[axis];
      const double inside = static_cast<double>(at[axis]) - begin;
      const double off = lowest[axis] < own[axis] ? inside : edge_m_ - inside;
      distances_sq[axis] = off * off;
    }
    return distances_sq;
  }
  /// Fetches what visit() will need first.
  void prefetch(const Cube& cube) const { __builtin_prefetch(&slots_[slotOf(keyOf(cube))]); }

  /// Calls visit(first, count) for each run of points in the cube.
  template <typename Visit>
  void visit(const Cube& cube, const Visit& visit) const {
    const std::uint64_t key = keyOf(cube);
    for (std::size_t at = slotOf(key); slots_[at].cube != kFree; at = (at + 1) & mask_) {
      if (slots_[at].cube == key) visit(slots_[at].first, slots_[at].count);
    }
  }

 private:
  static constexpr std::uint64_t kFree = ~std::uint64_t{0};

  /// How many points begin another cube of 2^level voxels than the point before them, by level.
  using Counts = std::array<std::size_t, kVoxelBits + 1>;

  static std::uint64_t keyOf(const Cube& cube) {
    return std::uint64_t{cube[0]} << 2 * kVoxelBits | std::uint64_t{cube[1]} << kVoxelBits |
           std::uint64_t{cube[2]};
  }
  std::uint32_t numberOf(double value, double from) const {
    const double number = (value - from) * inverse_;
    return static_cast<std::uint32_t>(std::min(std::max(number, 0.0), 2 * kVoxelLimit - 1));
  }
  std::size_t slotOf(std::uint64_t key) const { return hashKey(key) & mask_; }
  void setEdge(double edge_m) { edge_m_ = edge_m, inverse_ = 1 / edge_m; }
  Counts countBegun(const PointBlock* blocks, std::size_t begin, std::size_t end) const;
  std::vector<Run> runsIn(const PointBlock* blocks, std::size_t begin, std::size_t end) const;
  void fill(const std::vector<std::vector<Run>>& parts);

  double edge_m_ = 1, inverse_ = 1;
  std::array<double, 3> low_{};
  std::size_t mask_ = 0;
  RawArray<Run> slots_;
};

}  // namespace paloc

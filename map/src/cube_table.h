#pragma once

#include <tbb/task_arena.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "paloc/core/types.h"
#include "paloc/map/point_block.h"
#include "prefetch.h"
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
    std::uint32_t first, count : 31, more : 1;  // whether the cube has more runs

    std::uint32_t last() const { return first + count - 1; }
  };
  using Cube = std::array<std::uint32_t, 3>;  ///< numbers of a cube along x, y, z

  CubeTable() = default;
  /// The curve goes through voxels of `voxel_m` of the grid in whose first voxel `low` lies, which
  /// no point lies below.
  CubeTable(const PointBlock* blocks, std::size_t points, const Point3f& low, double voxel_m,
            tbb::task_arena& arena);

  double edge() const { return edge_m_; }  ///< of a cube (m)
  std::size_t bytes() const { return slots_.size() * sizeof(Run); }

  Cube cubeOf(const Point3f& p) const {
    return {numberOf(p.x, low_[0]), numberOf(p.y, low_[1]), numberOf(p.z, low_[2])};
  }
  /// A cube that is looked at on the way to a point, in two steps: prefetch(), then open().
  struct Place {
    std::uint64_t cube;
    float apart_sq;  // square of the distance from the point (m2)
    const Run* run;  // its first run, once it is opened; null: no point in it
  };
  /// The cube of a point, and the distances to its neighbours.
  struct Surroundings {
    Place home;
    // Squares of the distances to the neighbours below and above, along each axis (m2).
    std::array<float, 3> below_sq, above_sq;
  };
  Surroundings about(const Point3f& p) const;
  using Neighbours = std::array<Place, 27>;
  /// The neighbours of the cube, along all axes, within a distance of the point; their number.
  static std::size_t neighboursWithin(float distance_sq, const Surroundings& about,
                                      Neighbours& neighbours);

  void prefetch(const Place& place) const { paloc::prefetch(&slots_[slotOf(place.cube)]); }
  void open(Place& place) const { place.run = find(slotOf(place.cube), place.cube); }
  /// The next run of the same cube, or null.
  const Run* next(const Run* run) const {
    if (run->more == 0) return nullptr;
    return find((static_cast<std::size_t>(run - slots_.data()) + 1) & mask_, run->cube);
  }

 private:
  static constexpr std::uint64_t kFree = ~std::uint64_t{0};

  /// How many points begin another cube of 2^level voxels than the point before them, by level.
  using Counts = std::array<std::size_t, kVoxelBits + 1>;

  static std::uint64_t keyOf(const Cube& cube) {
    return std::uint64_t{cube[0]} << 2 * kVoxelBits | std::uint64_t{cube[1]} << kVoxelBits |
           std::uint64_t{cube[2]};
  }
  std::uint32_t numberOf(float value, double from) const {
    const double number = (static_cast<double>(value) - from) * inverse_;
    const double bounded = std::min(std::max(number, 0.0), 2 * kVoxelLimit - 1);
    return static_cast<std::uint32_t>(static_cast<std::int32_t>(bounded));  // the quicker way
  }
  const Run* find(std::size_t at, std::uint64_t key) const {
    for (; slots_[at].cube != kFree; at = (at + 1) & mask_) {
      if (slots_[at].cube == key) return &slots_[at];
    }
    return nullptr;
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

inline CubeTable::Surroundings CubeTable::about(const Point3f& p) const {
  Surroundings about{};
  const Cube home = cubeOf(p);
  about.home = {keyOf(home), 0, nullptr};
  const std::array<float, 3> at{p.x, p.y, p.z};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double begin = low_[axis] + edge_m_ * home[axis];
    const double inside = static_cast<double>(at[axis]) - begin, left = edge_m_ - inside;
    // Below the first cube there is none.
    about.below_sq[axis] = home[axis] > 0 ? static_cast<float>(inside * inside)
                                          : std::numeric_limits<float>::infinity();
    about.above_sq[axis] = static_cast<float>(left * left);
  }
  return about;
}

inline std::size_t CubeTable::neighboursWithin(float distance_sq, const Surroundings& about,
                                               Neighbours& neighbours) {
  std::size_t count = 1;
  neighbours[0] = about.home;
  // Of those found so far, and of the cube itself, the neighbours along one axis more.
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::uint64_t step = std::uint64_t{1} << (2 - axis) * kVoxelBits;
    const float below_sq = about.below_sq[axis], above_sq = about.above_sq[axis];
    if (below_sq > distance_sq && above_sq > distance_sq) continue;
    const std::size_t before = count;
    for (std::size_t i = 0; i < before; ++i) {
      const auto [cube, apart_sq, run] = neighbours[i];
      if (apart_sq + below_sq <= distance_sq) {
        neighbours[count++] = {cube - step, apart_sq + below_sq, nullptr};
      }
      if (apart_sq + above_sq <= distance_sq) {
        neighbours[count++] = {cube + step, apart_sq + above_sq, nullptr};
      }
    }
  }
  neighbours[0] = neighbours[--count];
  return count;
}

}  // namespace paloc

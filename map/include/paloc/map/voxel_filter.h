#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "paloc/core/export.h"
#include "paloc/core/types.h"

namespace paloc {

/// Thins a cloud: of the points in each cubic voxel, the one nearest to their centroid is kept.
/// (The centroid itself would lie off both surfaces in the voxel of an edge.) Deterministic: the
/// result depends on the points and their order alone, voxels come in the order of their first
/// point, and of two points equally near the first wins. Keeps its hash table from call to call;
/// one object serves one thread.
class PALOC_EXPORT VoxelFilter {
 public:
  /// The points kept, as indices. `voxel_m` > 0. Voxels are numbered from the origin of the points
  /// with 21 bits an axis; what lies further than 2^20 voxels away shares the outermost one.
  std::vector<std::uint32_t> select(std::span<const Point3f> points, double voxel_m);

 private:
  struct Cell {
    std::uint64_t key = 0;
    double x = 0, y = 0, z = 0;  // sums, then the centroid
    std::uint32_t count = 0;
    std::uint32_t best = 0;
    double best_sq = std::numeric_limits<double>::max();
  };

  std::uint64_t growTable();
  void hashPoints(std::span<const Point3f> points, double voxel_m);

  std::vector<std::uint32_t>
      slots_;  // cells, by hash; a power of two, at most a quarter of them taken
  std::vector<std::uint32_t> cell_of_;  // of each point
  std::vector<Cell> cells_;
};

}  // namespace paloc

#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "memory_budget.h"
#include "paloc/core/types.h"
#include "raw_array.h"

namespace paloc {

/// The centroids of the points in each voxel of a grid about zero, grown point by point: a cloud is
/// thinned while it is read, and is never in memory as a whole. Voxels stand in the order in which
/// they were met first: same points, same bytes.
class VoxelAccumulator {
 public:
  /// `name` is what errors call the cloud.
  VoxelAccumulator(double edge_m, const MemoryBudget& budget, std::string name);

  /// Adds points (m) and, unless it is empty, the intensity of each. Throws IoError when a point is
  /// more than 2^20 voxels from zero, when there are 2^32 - 1 voxels, or when they outgrow the
  /// budget.
  void add(std::span<const Point3f> points, std::span<const float> intensity);

  std::size_t size() const { return size_; }
  /// Moves the centroids, and the mean intensities if there were any, into vectors. Empty then.
  void take(std::vector<Point3f>& points, std::vector<float>* intensity);

 private:
  struct Cell {
    std::uint64_t key;
    float x, y, z;  ///< mean of the points, from the voxel's low corner (m)
    float intensity;
    std::uint32_t points;
  };
  static constexpr std::size_t kPieceCells = 1 << 18;

  Cell& cell(std::size_t index) { return pieces_[index / kPieceCells][index % kPieceCells]; }
  void hashAll(std::span<const Point3f> points);
  Cell& find(std::uint64_t key, std::uint64_t hash);
  static RawArray<std::uint32_t> emptySlots(std::size_t count);
  void growSlots();
  void growCells();
  void require(std::size_t more_bytes) const;

  double edge_m_, inverse_;
  MemoryBudget budget_;
  std::string name_;
  std::vector<RawArray<Cell>> pieces_;
  std::size_t size_ = 0;
  RawArray<std::uint32_t> slots_;  ///< number of a cell, or kEmpty; a power of two of them
  std::vector<std::uint64_t> keys_, hashes_;  ///< of the points being added
};

}  // namespace paloc

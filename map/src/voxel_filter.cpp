#include "paloc/map/voxel_filter.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "voxel_key.h"

namespace paloc {
namespace {

constexpr std::size_t kFewestSlots = 1 << 12;
constexpr std::size_t kSlotsACell = 4;  // at least: most searches then end at the first slot
constexpr std::uint32_t kFree = std::numeric_limits<std::uint32_t>::max();

}  // namespace

// The table follows the number of voxels, not that of points: it then fits in the cache. Returns
// the mask that takes a hash to a slot.
std::uint64_t VoxelFilter::growTable() {
  slots_.assign(std::max(kFewestSlots, 2 * slots_.size()), kFree);
  const std::uint64_t mask = slots_.size() - 1;
  for (std::uint32_t cell = 0; cell < cells_.size(); ++cell) {
    std::uint64_t at = hashKey(cells_[cell].key) & mask;
    while (slots_[at] != kFree) at = (at + 1) & mask;
    slots_[at] = cell;
  }
  return mask;
}

// Gives each point its cell, and each cell the sum of its points.
void VoxelFilter::hashPoints(std::span<const Point3f> points, double voxel_m) {
  std::fill(slots_.begin(), slots_.end(), kFree);
  cell_of_.resize(points.size());
  cells_.clear();
  std::uint64_t mask = slots_.empty() ? growTable() : slots_.size() - 1;
  const double inverse = 1 / voxel_m;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Point3f& p = points[i];
    const std::uint64_t key = voxelIndex(p.x, inverse) | voxelIndex(p.y, inverse) << kVoxelBits |
                              voxelIndex(p.z, inverse) << (2 * kVoxelBits);
    std::uint64_t at = hashKey(key) & mask;
    while (slots_[at] != kFree && cells_[slots_[at]].key != key) at = (at + 1) & mask;
    std::uint32_t index = slots_[at];
    if (index == kFree) {
      index = slots_[at] = static_cast<std::uint32_t>(cells_.size());
      cells_.push_back({.key = key});
      if (kSlotsACell * cells_.size() > slots_.size()) mask = growTable();
    }
    cell_of_[i] = index;
    Cell& cell = cells_[index];
    cell.x += static_cast<double>(p.x);
    cell.y += static_cast<double>(p.y);
    cell.z += static_cast<double>(p.z);
    ++cell.count;
  }
}

std::vector<std::uint32_t> VoxelFilter::select(std::span<const Point3f> points, double voxel_m) {
  hashPoints(points, voxel_m);
  for (Cell& cell : cells_) {
    const double inverse_count = 1.0 / cell.count;
    cell.x *= inverse_count;
    cell.y *= inverse_count;
    cell.z *= inverse_count;
  }
  for (std::size_t i = 0; i < points.size(); ++i) {
    Cell& cell = cells_[cell_of_[i]];
    const double dx = static_cast<double>(points[i].x) - cell.x;
    const double dy = static_cast<double>(points[i].y) - cell.y;
    const double dz = static_cast<double>(points[i].z) - cell.z;
    const double distance_sq = dx * dx + dy * dy + dz * dz;
    // No branch: which point is nearer cannot be foreseen.
    const bool nearer = distance_sq < cell.best_sq;
    cell.best_sq = nearer ? distance_sq : cell.best_sq;
    cell.best = nearer ? static_cast<std::uint32_t>(i) : cell.best;
  }
  std::vector<std::uint32_t> kept(cells_.size());
  for (std::size_t c = 0; c < cells_.size(); ++c) kept[c] = cells_[c].best;
  return kept;
}

}  // namespace paloc

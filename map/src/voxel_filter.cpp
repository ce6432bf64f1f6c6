#include "paloc/map/voxel_filter.h"

#include <bit>
#include <cmath>

#include "voxel_key.h"

namespace paloc {
namespace {

// However large, voxels that meet at the origin part the points about it into eight.
constexpr std::size_t kOctants = 8;

}  // namespace

// Gives each point its cell, and each cell the sum of its points.
void VoxelFilter::hashPoints(std::span<const Point3f> points, double voxel_m) {
  const std::size_t slots = std::bit_ceil(2 * points.size() + 2);
  const std::uint64_t mask = slots - 1;
  keys_.resize(slots);
  slots_.assign(slots, 0);
  cell_of_.resize(points.size());
  cells_.clear();
  const double inverse = 1 / voxel_m;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Point3f& p = points[i];
    const std::uint64_t key = voxelIndex(p.x, inverse) | voxelIndex(p.y, inverse) << kVoxelBits |
                              voxelIndex(p.z, inverse) << (2 * kVoxelBits);
    std::uint64_t slot = hashKey(key) & mask;
    while (slots_[slot] != 0 && keys_[slot] != key) slot = (slot + 1) & mask;
    if (slots_[slot] == 0) {
      keys_[slot] = key;
      cells_.emplace_back();
      slots_[slot] = static_cast<std::uint32_t>(cells_.size());
    }
    const std::uint32_t cell_index = slots_[slot] - 1;
    cell_of_[i] = cell_index;
    Cell& cell = cells_[cell_index];
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
    cell.best_sq = -1;
  }
  for (std::size_t i = 0; i < points.size(); ++i) {
    Cell& cell = cells_[cell_of_[i]];
    const double dx = static_cast<double>(points[i].x) - cell.x;
    const double dy = static_cast<double>(points[i].y) - cell.y;
    const double dz = static_cast<double>(points[i].z) - cell.z;
    const double distance_sq = dx * dx + dy * dy + dz * dz;
    if (cell.best_sq < 0 || distance_sq < cell.best_sq) {
      cell.best_sq = distance_sq;
      cell.best = static_cast<std::uint32_t>(i);
    }
  }
  std::vector<std::uint32_t> kept(cells_.size());
  for (std::size_t c = 0; c < cells_.size(); ++c) kept[c] = cells_[c].best;
  return kept;
}

std::vector<std::uint32_t> VoxelFilter::selectAtMost(std::span<const Point3f> points,
                                                     double finest_voxel_m,
                                                     std::size_t max_points) {
  const std::vector<std::uint32_t> fine = select(points, finest_voxel_m);
  if (fine.size() <= max_points) return fine;
  std::vector<Point3f> thinned(fine.size());
  for (std::size_t i = 0; i < fine.size(); ++i) thinned[i] = points[fine[i]];

  // On surfaces the number of voxels falls with the square of their edge, a little less where
  // points are sparse: each try starts from the count of the one before, and always grows.
  double voxel = finest_voxel_m;
  std::size_t count = fine.size();
  std::vector<std::uint32_t> kept;
  do {
    const double ratio = static_cast<double>(count) / static_cast<double>(max_points);
    voxel *= std::max(1.02, std::sqrt(ratio) * 1.01);
    kept = select(thinned, voxel);
    count = kept.size();
  } while (count > max_points && count > kOctants);
  if (count > max_points) kept.resize(max_points);
  for (std::uint32_t& index : kept) index = fine[index];
  return kept;
}

}  // namespace paloc

#include "paloc/map/voxel_filter.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "voxel_key.h"

namespace paloc {
namespace {

// However large, voxels that meet at the origin part the points about it into eight.
constexpr std::size_t kOctants = 8;
constexpr std::size_t kFewestSlots = 1 << 12;
constexpr std::size_t kSlotsACell = 4;  // at least: most searches then end at the first slot
constexpr std::uint32_t kFree = std::numeric_limits<std::uint32_t>::max();
// So many times the points wanted are enough to choose from.
constexpr std::size_t kEnoughChoice = 8;

// One point of each run of `run` points, each time another one of it: a fixed step would meet the
// same lasers of a scanner again and again.
std::vector<std::uint32_t> onePerRun(std::size_t points, std::size_t run) {
  std::vector<std::uint32_t> some(points / run);
  for (std::size_t k = 0; k < some.size(); ++k) {
    some[k] = static_cast<std::uint32_t>(k * run + (hashKey(k + 1) >> 32) % run);
  }
  return some;
}

std::vector<Point3f> pointsAt(std::span<const Point3f> points,
                              std::span<const std::uint32_t> indices) {
  std::vector<Point3f> chosen(indices.size());
  for (std::size_t i = 0; i < indices.size(); ++i) chosen[i] = points[indices[i]];
  return chosen;
}

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

std::vector<std::uint32_t> VoxelFilter::selectAtMost(std::span<const Point3f> points,
                                                     double finest_voxel_m,
                                                     std::size_t max_points) {
  const std::size_t run = points.size() / (kEnoughChoice * max_points);
  if (run > 1) {
    const std::vector<std::uint32_t> some = onePerRun(points.size(), run);
    std::vector<std::uint32_t> kept =
        selectAtMost(pointsAt(points, some), finest_voxel_m, max_points);
    for (std::uint32_t& index : kept) index = some[index];
    return kept;
  }
  const std::vector<std::uint32_t> fine = select(points, finest_voxel_m);
  if (fine.size() <= max_points) return fine;
  const std::vector<Point3f> thinned = pointsAt(points, fine);

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

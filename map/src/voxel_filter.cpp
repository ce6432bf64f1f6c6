#include "paloc/map/voxel_filter.h"

#include <algorithm>
#include <cmath>

#include "voxel_key.h"

namespace paloc {
namespace {

// However large, voxels that meet at the origin part the points about it into eight.
constexpr std::size_t kOctants = 8;
constexpr std::size_t kFewestSlots = 1 << 12;
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

// The number of the cell of a voxel, made if it is new.
std::uint32_t VoxelFilter::cellOf(std::uint64_t key) {
  if (2 * (cells_.size() + 1) > slots_.size()) growTable();
  const std::uint64_t mask = slots_.size() - 1;
  std::uint64_t at = hashKey(key) & mask;
  while (slots_[at].cell_plus_one != 0 && slots_[at].key != key) at = (at + 1) & mask;
  if (slots_[at].cell_plus_one == 0) {
    cells_.emplace_back();
    slots_[at] = {key, static_cast<std::uint32_t>(cells_.size())};
  }
  return slots_[at].cell_plus_one - 1;
}

// The table follows the number of voxels, not that of points: it then fits in the cache.
void VoxelFilter::growTable() {
  std::vector<Slot> old(std::max(kFewestSlots, 2 * slots_.size()));
  old.swap(slots_);
  const std::uint64_t mask = slots_.size() - 1;
  for (const Slot& slot : old) {
    if (slot.cell_plus_one == 0) continue;
    std::uint64_t at = hashKey(slot.key) & mask;
    while (slots_[at].cell_plus_one != 0) at = (at + 1) & mask;
    slots_[at] = slot;
  }
}

// Gives each point its cell, and each cell the sum of its points.
void VoxelFilter::hashPoints(std::span<const Point3f> points, double voxel_m) {
  std::fill(slots_.begin(), slots_.end(), Slot{});
  cell_of_.resize(points.size());
  cells_.clear();
  const double inverse = 1 / voxel_m;
  std::uint64_t last_key = ~std::uint64_t{0};  // of no voxel: its top bit is set
  std::uint32_t cell_index = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Point3f& p = points[i];
    const std::uint64_t key = voxelIndex(p.x, inverse) | voxelIndex(p.y, inverse) << kVoxelBits |
                              voxelIndex(p.z, inverse) << (2 * kVoxelBits);
    if (key != last_key) {  // neighbours in a scan often share a voxel
      cell_index = cellOf(key);
      last_key = key;
    }
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

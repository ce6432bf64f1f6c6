#include "paloc/frontends/local_voxel_map.h"

#include <algorithm>

namespace paloc {

LocalVoxelMap::LocalVoxelMap(const LocalMapSettings& limits) : limits_(limits) {
  double edge_m = limits.voxel_m;
  for (int i = 0; i < std::max(limits.levels, 1); ++i) {
    levels_.emplace_back(edge_m);
    edge_m *= limits.level_factor;
  }
}

bool LocalVoxelMap::add(const Vec3& point, const Vec3& ray) {
  bool taken = true;
  for (PlaneVoxels& level : levels_) taken = level.add(point, ray, now_) && taken;
  return taken;
}

bool LocalVoxelMap::find(const Vec3& point, const Vec3& ray, LocalPlane& plane,
                         double least_voxel_m) const {
  for (const PlaneVoxels& level : levels_) {
    if (level.edge() < least_voxel_m && &level != &levels_.back()) continue;
    if (level.find(point, ray, plane)) return true;
  }
  return false;
}

void LocalVoxelMap::endScan(const Vec3& around) {
  ++now_;
  const auto max_voxels = static_cast<std::size_t>(limits_.max_voxels);
  for (PlaneVoxels& level : levels_) {
    if (level.size() > max_voxels) {
      level.forget(around, limits_.max_distance_m, max_voxels);
    }
  }
}

void LocalVoxelMap::clear() {
  for (PlaneVoxels& level : levels_) level.clear();
}

std::size_t LocalVoxelMap::voxels() const {
  std::size_t sum = 0;
  for (const PlaneVoxels& level : levels_) sum += level.size();
  return sum;
}

std::size_t LocalVoxelMap::bytes() const {
  std::size_t sum = 0;
  for (const PlaneVoxels& level : levels_) sum += level.bytes();
  return sum;
}

}  // namespace paloc

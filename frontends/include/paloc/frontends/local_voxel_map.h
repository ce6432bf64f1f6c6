#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "paloc/core/export.h"
#include "paloc/frontends/local_map_settings.h"
#include "paloc/frontends/plane_voxels.h"

namespace paloc {

/// The surroundings as an odometry has seen them: planes in voxels of several sizes. The coarse
/// ones serve where points are too few for the fine ones, as between the rings of a sensor that has
/// few. Memory is bounded: when there are more voxels than allowed, those far away are forgotten,
/// then those seen longest ago.
class PALOC_EXPORT LocalVoxelMap {
 public:
  explicit LocalVoxelMap(const LocalMapSettings& limits);

  /// Adds a point in the map's frame (m), seen along `ray` (sensor to point, any length). False if
  /// it lies beyond all voxels, 2^20 of them from zero.
  bool add(const Vec3& point, const Vec3& ray);

  /// The plane about a point, seen along `ray`: of the smallest voxel that has one, and is not
  /// smaller than `least_voxel_m` unless none is larger. False if there is none.
  bool find(const Vec3& point, const Vec3& ray, LocalPlane& plane, double least_voxel_m = 0) const;

  /// To be called after each scan, at the sensor's position (m): time goes on, and what is too much
  /// is forgotten.
  void endScan(const Vec3& around);

  void clear();
  bool empty() const { return levels_.front().size() == 0; }
  std::size_t voxels() const;
  std::size_t bytes() const;

 private:
  LocalMapSettings limits_;
  std::vector<PlaneVoxels> levels_;  // finest first
  std::uint32_t now_ = 0;            // scans so far
};

}  // namespace paloc

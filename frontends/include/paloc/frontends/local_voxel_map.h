#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "paloc/core/export.h"
#include "paloc/frontends/plane_voxels.h"

namespace paloc {

/// How fine a local map is and how much it keeps.
struct LocalMapLimits {
  double voxel_m = 0.2;       ///< edge of the finest voxels
  double level_factor = 2.5;  ///< from one size to the next
  int levels = 3;
  std::size_t max_voxels = 150'000;  ///< of each size
  double max_distance_m = 100;       ///< what is further away is the first to be forgotten
};

/// The surroundings as an odometry has seen them: planes in voxels of several sizes. The coarse
/// ones serve where points are too few for the fine ones, as between the rings of a sensor that has
/// few. Memory is bounded: when there are more voxels than allowed, those far away are forgotten,
/// then those seen longest ago.
class PALOC_EXPORT LocalVoxelMap {
 public:
  explicit LocalVoxelMap(const LocalMapLimits& limits);

  /// Adds a point in the map's frame (m), seen along `ray` (sensor to point, any length). False if
  /// it lies beyond all voxels, 2^20 of them from zero.
  bool add(const Vec3& point, const Vec3& ray);

  /// The plane about a point, seen along `ray`: of the smallest voxel that has one. False if there
  /// is none.
  bool find(const Vec3& point, const Vec3& ray, LocalPlane& plane) const;

  /// To be called after each scan, at the sensor's position (m): time goes on, and what is too much
  /// is forgotten.
  void endScan(const Vec3& around);

  void clear();
  bool empty() const { return levels_.front().size() == 0; }
  std::size_t voxels() const;
  std::size_t bytes() const;

 private:
  LocalMapLimits limits_;
  std::vector<PlaneVoxels> levels_;  // finest first
  std::uint32_t now_ = 0;            // scans so far
};

}  // namespace paloc

#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "paloc/core/export.h"
#include "paloc/core/types.h"

namespace paloc {

/// A plane of a local map, in the map's frame.
struct LocalPlane {
  Vec3 normal = Vec3::Zero();    ///< unit, towards the side that it was seen from
  Vec3 centroid = Vec3::Zero();  ///< of its points (m)
  double thickness_m = 0;        ///< standard deviation of its points across it, noise included
  double width_m = 0;            ///< and along it, in the narrower direction
  int points = 0;

  /// Height of a point over the plane (m).
  double height(const Vec3& point) const { return normal.dot(point - centroid); }
  /// By how much the plane is less sure at a point than at its centroid, where its variance is that
  /// of a point over their number: as of a regression's value.
  double leverFactor(const Vec3& point) const {
    const Vec3 away = point - centroid;
    const double across = normal.dot(away);
    return 1 + (away.squaredNorm() - across * across) / (width_m * width_m);
  }
};

/// Cubic voxels of one size, each with the running moments of its points and the plane that these
/// make (after VoxelMap: C. Yuan et al., "Efficient and Probabilistic Adaptive Voxel Mapping for
/// Accurate Online LiDAR Odometry", 2022). The plane is fitted anew when the voxel has gained
/// enough points; a voxel that has many takes no more. Where a surface is also seen from behind (a
/// thin wall), the points from there make a plane of their own. Same calls, same bytes.
class PALOC_EXPORT PlaneVoxels {
 public:
  explicit PlaneVoxels(double edge_m) : edge_m_(edge_m) {}

  /// Adds a point (m) that was seen along `ray` (sensor to point, any length); `now` is kept as the
  /// time when its voxel was last seen. Points further from zero than 2^20 voxels are not taken:
  /// false.
  bool add(const Vec3& point, const Vec3& ray, std::uint32_t now);

  /// The plane of the voxel that the point is in, seen along `ray`; false if there is none, or only
  /// its other side.
  bool find(const Vec3& point, const Vec3& ray, LocalPlane& plane) const;

  /// Forgets voxels further than `max_distance_m` from `around` (m), then, if more than
  /// `max_voxels` are left, those seen longest ago until three quarters of that are left at most.
  void forget(const Vec3& around, double max_distance_m, std::size_t max_voxels);
  void clear();

  std::size_t size() const { return cells_.size(); }
  double edge() const { return edge_m_; }
  std::size_t bytes() const;

 private:
  struct Plane {
    float nx = 0, ny = 0, nz = 0;  ///< unit normal
    float cx = 0, cy = 0, cz = 0;  ///< centroid from the voxel's centre (m)
    float thickness = -1;          ///< m; negative: not a plane
    float width = 0;               ///< m
  };
  struct Cell {
    std::uint64_t key = 0;
    std::array<float, 3> mean{};     ///< from the voxel's centre (m)
    std::array<float, 6> scatter{};  ///< sums of products of deviations: xx xy xz yy yz zz (m2)
    std::array<float, 3> view{};     ///< mean of the unit rays that they were seen along
    std::uint32_t points = 0;
    std::uint32_t fitted = 0;  ///< how many of them the plane was fitted to
    std::uint32_t seen = 0;    ///< when, last
  };
  struct Slot {
    std::uint64_t key = 0;
    std::uint32_t cell = 0;
  };

  std::uint32_t lookUp(std::uint64_t key) const;
  std::uint32_t lookUpOrMake(std::uint64_t key);
  void rebuildSlots(std::size_t count);
  void keepOnly(const std::vector<bool>& kept);
  void fit(std::uint32_t cell, const Vec3& ray);

  double edge_m_;
  std::vector<Slot> slots_;    // by hash; a power of two, at most half of them taken
  std::vector<Cell> cells_;    // in the order in which they were met
  std::vector<Plane> planes_;  // of each cell
};

}  // namespace paloc

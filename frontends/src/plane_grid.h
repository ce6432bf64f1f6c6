#pragma once

#include <cstdint>
#include <optional>
#include <unordered_map>

#include "paloc/core/types.h"

namespace paloc {

/// A small map of surfaces: a plane in each voxel whose points lie on one. For comparing
/// consecutive scans; the registration to prior maps has a better one (map/).
class PlaneGrid {
 public:
  explicit PlaneGrid(double voxel_m) : inverse_(1 / voxel_m), voxel_m_(voxel_m) {}

  void add(const Vec3& point);

  struct Plane {
    Vec3 point;   ///< on the plane: the mean of its points
    Vec3 normal;  ///< unit
  };
  /// The plane of the voxel that a point lies in, if there is one.
  std::optional<Plane> at(const Vec3& point);

 private:
  struct Cell {
    int count = 0, fitted = 0;  // points; points at the last fit
    Vec3 sum = Vec3::Zero();    // from the voxel's corner
    Mat3 squares = Mat3::Zero();
    bool planar = false;
    Plane plane;
  };

  std::uint64_t keyOf(const Vec3& point, Vec3& corner) const;
  void fit(Cell& cell, const Vec3& corner) const;

  double inverse_, voxel_m_;
  std::unordered_map<std::uint64_t, Cell> cells_;
};

}  // namespace paloc

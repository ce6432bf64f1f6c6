#pragma once

#include <array>

#include "paloc/core/types.h"
#include "paloc/map/map_plane.h"

namespace paloc {

/// Sums over points (m, m2).
struct MomentSums {
  int count = 0;
  std::array<double, 3> first{};   // x, y, z
  std::array<double, 6> second{};  // xx, xy, xz, yy, yz, zz

  void add(double x, double y, double z) {
    ++count;
    first[0] += x, first[1] += y, first[2] += z;
    second[0] += x * x, second[1] += x * y, second[2] += x * z;
    second[3] += y * y, second[4] += y * z, second[5] += z * z;
  }
};

/// Mean and principal axes of some points.
struct PlaneMoments {
  PlaneMoments() = default;
  /// Of at least three points; of fewer, none.
  explicit PlaneMoments(const MomentSums& sums);

  Vec3 centroid = Vec3::Zero();
  Vec3 normal = Vec3::Zero();     // the axis of the least variance
  Vec3 variances = Vec3::Zero();  // ascending
  int count = 0;
};

/// Whether the variance of the points is larger than that along every axis: without the axes, which
/// take longer. Of fewer than three points it is not.
bool thickerThan(double variance, const MomentSums& sums);

/// The plane about the origin, unless the moments are none of a plane (see fitPlane).
MapPlane planeOf(const PlaneMoments& moments, const PlaneFitLimits& limits);

}  // namespace paloc

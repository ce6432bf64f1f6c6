#pragma once

#include <array>

#include "paloc/core/types.h"
#include "paloc/map/map_plane.h"

namespace paloc {

/// Sums over points: x, y, z, xx, xy, xz, yy, yz, zz (m, m2).
using MomentSums = std::array<double, 9>;

/// Mean and principal axes of some points.
struct PlaneMoments {
  PlaneMoments() = default;
  /// At least three points.
  PlaneMoments(const MomentSums& sums, int points);

  Vec3 centroid = Vec3::Zero();
  Vec3 normal = Vec3::Zero();     // the axis of the least variance
  Vec3 variances = Vec3::Zero();  // ascending
  int count = 0;
};

/// The plane about the origin, unless the moments are none of a plane (see fitPlane).
MapPlane planeOf(const PlaneMoments& moments, const PlaneFitLimits& limits);

}  // namespace paloc

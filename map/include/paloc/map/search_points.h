#pragma once

#include <span>
#include <vector>

#include "paloc/core/export.h"
#include "paloc/core/types.h"

namespace paloc {

/// A few points of a scan that tell where it was taken, evenly spread over its surfaces, in a
/// level frame: turned so that z points up, the heading being the body's (m, from the body).
struct SearchPoints {
  std::vector<Vec3> upright;  ///< of walls and what else stands up: they tell x, y and heading
  std::vector<Vec3> others;   ///< floor, ceiling and the rest: they tell z
  double reach_m = 0;         ///< most of the points are no further away than this, horizontally

  std::size_t size() const { return upright.size() + others.size(); }
};

/// Picks them. A point belongs to what stands up if its column of the scan is filled at several
/// heights. `spacing_m` is the finest distance between two of them.
PALOC_EXPORT SearchPoints pickSearchPoints(std::span<const Point3f> points_body,
                                           const Mat3& R_level_body, double spacing_m);

}  // namespace paloc

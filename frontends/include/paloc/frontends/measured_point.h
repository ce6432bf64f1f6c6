#pragma once

#include <algorithm>
#include <cmath>
#include <span>

#include "paloc/core/types.h"

namespace paloc {

/// A point of a scan as it was measured.
struct MeasuredPoint {
  Vec3 point_body = Vec3::Zero();  ///< in the body frame at its own time (m)
  double age_s = 0;                ///< how long before the end of the scan that was
};

/// Root of the mean squared range from the body (m): the lever of its rotation. 0 without points.
inline double rmsRange(std::span<const MeasuredPoint> points) {
  double sum = 0;
  for (const MeasuredPoint& p : points) sum += p.point_body.squaredNorm();
  return std::sqrt(sum / static_cast<double>(std::max<std::size_t>(points.size(), 1)));
}

}  // namespace paloc

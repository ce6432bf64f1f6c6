#pragma once

#include "paloc/core/export.h"
#include "paloc/map/point_cloud.h"

namespace paloc {

/// What a cloud looks like from outside, for reports.
struct CloudDescription {
  Vec3 low = Vec3::Zero(), high = Vec3::Zero();  ///< bounding box in the cloud's frame (m)
  /// Median distance of a point to its nearest neighbour (m), of up to 5000 points evenly taken
  /// from the cloud; points at the same place count as one.
  double spacing_m = 0;
};

/// Throws UsageError for an empty cloud.
PALOC_EXPORT CloudDescription describeCloud(const PointCloud& cloud);

}  // namespace paloc

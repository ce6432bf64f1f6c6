#pragma once

#include "paloc/core/fixed_lag_smoother.h"
#include "paloc/core/map_matcher.h"
#include "paloc/core/trajectory.h"

namespace paloc {

/// A node's estimate as a point of the result, with what the map said of its directions. Its flag
/// is not set yet.
PALOC_EXPORT TrajectoryPoint trajectoryPoint(const NodeEstimate& estimate, const MapMatch& match);

}  // namespace paloc

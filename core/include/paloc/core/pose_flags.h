#pragma once

#include <vector>

#include "paloc/core/estimator_settings.h"
#include "paloc/core/trajectory.h"

namespace paloc {

/// Sets the flag of every point. `has_map_factor` tells, for each, whether the map was used there.
PALOC_EXPORT void setPoseFlags(const std::vector<bool>& has_map_factor,
                               const EstimatorSettings& settings,
                               std::vector<TrajectoryPoint>& points);

}  // namespace paloc

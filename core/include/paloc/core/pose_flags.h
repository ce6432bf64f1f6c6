#pragma once

#include <string>
#include <vector>

#include "paloc/core/estimator_settings.h"
#include "paloc/core/trajectory.h"

namespace paloc {

/// Sets the flag of every point. `has_map_factor` tells, for each, whether the map was used there.
PALOC_EXPORT void setPoseFlags(const std::vector<bool>& has_map_factor,
                               const EstimatorSettings& settings,
                               std::vector<TrajectoryPoint>& points);

/// Why a run has no trajectory at all, in one sentence.
PALOC_EXPORT std::string noTrajectoryReason(std::size_t frames, bool has_initial_pose,
                                            int start_attempts, MatchRefusal last_refusal);

}  // namespace paloc

#pragma once

#include <vector>

#include "paloc/core/export.h"
#include "paloc/core/pose.h"
#include "paloc/core/smooth_recording.h"
#include "paloc/core/state.h"
#include "paloc/core/trajectory.h"

namespace paloc {

/// The first of the nodes at the end of `history` that belong to where the body is found next: that
/// after the last one that the map fixed, or after the last gap since, which nothing measured.
PALOC_EXPORT std::size_t firstLost(const std::vector<HistoryNode>& history,
                                   const std::vector<FrameDiagnostics>& diagnostics);

/// Moves a state rigidly: `T_new_old` takes positions of the map as the state had it to what they
/// are. Gravity stays, since it was known all along.
PALOC_EXPORT void displace(const Pose& T_new_old, State& state);

}  // namespace paloc

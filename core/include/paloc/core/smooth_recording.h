#pragma once

#include <vector>

#include "paloc/core/chain.h"
#include "paloc/core/estimator_settings.h"
#include "paloc/core/export.h"
#include "paloc/core/map_association.h"
#include "paloc/core/map_matcher.h"
#include "paloc/core/stage_timer.h"
#include "paloc/core/trajectory.h"

namespace paloc {

/// A node of the recording, kept until the end.
struct HistoryNode {
  ChainNode node;                     ///< with the factors as they were given, for the batch
  std::size_t diagnostics_index = 0;  ///< its row
  MapAssociation association;
};

/// Smooths all nodes, associates scans with the map anew where that moved their poses, and smooths
/// again. Fills the trajectory, its covariances and the counts of `result`; on failure that stays
/// without a trajectory. The associations in `history` are then the ones that were used last.
PALOC_EXPORT void smoothRecording(const EstimatorSettings& settings, MapMatcher& matcher,
                                  StageTimer* timer, std::vector<HistoryNode>& history,
                                  Result& result);

}  // namespace paloc

#pragma once

#include <vector>

#include "paloc/map/prior_map.h"
#include "ray_targets.h"
#include "ray_votes.h"

namespace paloc {

/// Returns that no surface of the map explains.
struct ChangeCandidates {
  std::vector<RayTarget> targets;  ///< the mean of them in each voxel of 5 cm; without planes
  Vec3 low = Vec3::Zero(), high = Vec3::Zero();  ///< box about all rays (local, m)
  std::size_t scans_used = 0, scans_unsure = 0;
};
ChangeCandidates gatherCandidates(const PriorMap& map, const ScanRaySource& scans,
                                  const ChangeMargins& margins, int threads);

/// Fits a plane to the neighbours of each target.
void fitPlanesTo(RayTargets& targets, int threads);

}  // namespace paloc

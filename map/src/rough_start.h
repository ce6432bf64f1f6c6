#pragma once

#include "registration.h"

namespace paloc {

/// What a search around a rough pose found.
struct RoughStart {
  Alignment alignment;       ///< the best one
  bool verified = false;     ///< enough points fit, and few rays pass through surfaces
  double fitting_share = 0;  ///< of the matched points, within 10 cm of their plane
  double blocked_share = 0;  ///< of the rays that were looked at
};

/// Registers the points set in `registration` from a rough pose (map-local, about 1 m and 10
/// degrees off): a fixed set of starts (the pose itself, turned, and moved sideways), each aligned
/// coarsely with gates that shrink; the one with the most points on their planes is aligned finely
/// and verified. Deterministic.
RoughStart searchAround(Registration& registration, const PriorMap& map,
                        const MatcherSettings& settings, const Pose& rough);

}  // namespace paloc

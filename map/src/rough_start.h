#pragma once

#include "registration.h"
#include "start_verification.h"

namespace paloc {

/// What a search around a rough pose found.
struct RoughStart {
  Alignment alignment;  ///< the best one
  StartEvidence evidence;
  MatchRefusal refusal = MatchRefusal::kNone;  ///< by the evidence
};

/// Registers the points set in `registration` from a rough pose (map-local, about 1 m and 10
/// degrees off): a fixed set of starts (the pose itself, turned, and moved sideways), each aligned
/// coarsely with gates that shrink; the one with the most points on their planes is aligned finely
/// and verified. Deterministic.
RoughStart searchAround(Registration& registration, const PriorMap& map,
                        const MatcherSettings& settings, const Pose& rough);

}  // namespace paloc

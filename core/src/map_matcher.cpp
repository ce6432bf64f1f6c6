#include "paloc/core/map_matcher.h"

namespace paloc {

std::string toString(MatchRefusal refusal) {
  switch (refusal) {
    case MatchRefusal::kNone:
      return "accepted";
    case MatchRefusal::kNotTried:
      return "not tried";
    case MatchRefusal::kNoScan:
      return "no scan";
    case MatchRefusal::kTooFewPoints:
      return "too few points";
    case MatchRefusal::kOutsideMap:
      return "outside the map";
    case MatchRefusal::kTooFewInliers:
      return "too few inliers";
    case MatchRefusal::kLowOverlap:
      return "low overlap";
    case MatchRefusal::kHighResidual:
      return "high residual";
    case MatchRefusal::kLargeStep:
      return "large step";
    case MatchRefusal::kNotConverged:
      return "not converged";
    case MatchRefusal::kMapContradicts:
      return "the map shows something else there";
    case MatchRefusal::kNotVerified:
      return "not verified";
    case MatchRefusal::kContradiction:
      return "contradicts the motion";
    case MatchRefusal::kNoPlaceFound:
      return "fits nowhere in the map";
    case MatchRefusal::kAmbiguous:
      return "ambiguous";
    case MatchRefusal::kSearchUnfinished:
      return "search not finished";
    case MatchRefusal::kNotConfirmed:
      return "not confirmed";
  }
  return "unknown";
}

}  // namespace paloc

#pragma once

#include "paloc/map/matcher_settings.h"
#include "registration.h"

namespace paloc {

/// What speaks for and against a start, at the result of an alignment.
struct StartEvidence {
  /// Of the points tried, those within 10 cm of the map's surface there. Points near a part of the
  /// map that is no surface (a bush, an edge) do not count either way.
  double explained = 0;
  double fitting = 0;  ///< the same of those only that found a surface
  double blocked = 0;  ///< of the rays, those that pass through a surface of the map
  /// Of the points tried, those that lie far off all surfaces where the map shows the ground below:
  /// the survey has seen that place, and found nothing there.
  double contradicted = 0;

  std::size_t rays = 0;  ///< that these two are shares of

  /// By which places are compared.
  double worth() const { return explained - blocked - contradicted; }
};

/// Whether that is enough to believe it, and else why not.
MatchRefusal judgeStart(const StartEvidence& evidence, const MatcherSettings& settings);

/// Whether it speaks so clearly against a place that this is no rival to another.
bool isRefuted(const StartEvidence& evidence, const MatcherSettings& settings);

/// Weighs the alignment that `registration` made last. `rays`: how many are followed at most.
StartEvidence weighStart(const Registration& registration, const Alignment& alignment,
                         const PriorMap& map, std::size_t rays);

/// Whether to believe the alignment that `registration` made last, and else why not. Where some of
/// the rays leave a doubt, all are followed, and are the evidence then.
MatchRefusal verifyStart(const Registration& registration, const Alignment& alignment,
                         const PriorMap& map, const MatcherSettings& settings,
                         StartEvidence& evidence);

}  // namespace paloc

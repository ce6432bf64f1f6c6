#pragma once

#include <memory>
#include <optional>

#include "paloc/map/start_search.h"
#include "registration.h"
#include "start_verification.h"

namespace paloc {

/// Where a start is sought, in the map's local frame.
struct StartRegion {
  SearchBox box;                         ///< headings turn `R_level_body` about the vertical
  Mat3 R_level_body = Mat3::Identity();  ///< takes the body's axes to a frame whose z points up
  std::optional<Pose> rough;             ///< the pose that somebody vouches for, map-local
};

/// What was found, or why it is not believed.
struct FoundStart {
  MatchRefusal refusal = MatchRefusal::kNoPlaceFound;
  Alignment alignment;     ///< of the best place; `registration` holds its rows
  StartEvidence evidence;  ///< for it
  double runner_up = 0;    ///< worth of the second-best place that the map does not refute
};

/// Finds a scan in a region of the map: a search over grids gives candidates, each is registered,
/// and the best is believed if the map explains enough of the scan, few rays pass through
/// surfaces, and no other place comes near it. The grids are made at the first call and kept.
class StartFinder {
 public:
  StartFinder(const PriorMap& map, const MatcherSettings& settings)
      : map_(map), settings_(settings) {}

  /// `points_body`: the whole scan; `registration` has it thinned.
  FoundStart find(const std::vector<Point3f>& points_body, const StartRegion& region,
                  Registration& registration);

  /// The box of the whole map, with any heading.
  SearchBox everywhere() const;

 private:
  struct Place {
    Alignment alignment;
    StartEvidence evidence;
  };

  const SearchMap& grids();
  std::vector<Place> placesOf(const StartCandidates& candidates, const StartRegion& region,
                              Registration& registration) const;
  Place registerFrom(const Pose& from, double first_gate_m, std::size_t rays,
                     Registration& registration) const;
  Place nudged(const Place& place, Registration& registration) const;
  MatchRefusal judge(FoundStart& found, bool finished, const Registration& registration) const;

  const PriorMap& map_;
  const MatcherSettings& settings_;
  std::unique_ptr<const SearchMap> grids_;
};

}  // namespace paloc

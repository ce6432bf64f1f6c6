#pragma once

#include <optional>

#include "paloc/core/confirmation.h"
#include "paloc/core/estimator_settings.h"
#include "paloc/core/export.h"
#include "paloc/core/map_matcher.h"
#include "paloc/core/pose.h"
#include "paloc/core/time.h"

namespace paloc {

/// What is expected of the body at a scan, from the motion alone.
struct ExpectedPose {
  TimeNs t_ns = 0;
  Pose T_map_body;
  Mat6 covariance = Mat6::Zero();  ///< tangent [position in the map, rotation on the right]
  Vec3 gravity_map = -Vec3::UnitZ();
  Pose T_last_body;  ///< motion since the last scan
};

/// Finds a body that was lost: carried away while nothing was recorded, or in the dark for long.
/// Registration from where it is expected must not be believed then, since any room looks a little
/// like any other: it is searched for, around the expected pose or in the whole map, and what a
/// search finds must be borne out by the scans that follow before it counts.
class PALOC_EXPORT Relocation {
 public:
  explicit Relocation(const EstimatorSettings& settings) : settings_(settings) {}

  /// Whether a pose so unsure is further from any map factor than registration reaches.
  static bool lost(const Mat6& covariance);

  /// The answer of the map to a scan of a lost body: accepted when the place is sure, and then it
  /// may be anywhere; "not confirmed" while a place found is being verified.
  MapMatch seek(MapMatcher& matcher, const Scan& scan, const ExpectedPose& expected);
  /// The body is not lost, or is found.
  void reset();

 private:
  struct Found {
    Pose T_map_body;
    Confirmation scans = {};
    Pose motion_since = {};
  };

  MapMatch search(MapMatcher& matcher, const Scan& scan, const ExpectedPose& expected);
  MapMatch verify(MapMatcher& matcher, const Scan& scan, const Pose& motion);

  const EstimatorSettings settings_;
  std::optional<Found> found_;
  std::optional<TimeNs> searched_ns_;
  int failures_ = 0;  // searches in a row
};

}  // namespace paloc

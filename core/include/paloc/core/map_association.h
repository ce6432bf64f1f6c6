#pragma once

#include <memory>

#include "paloc/core/estimator_settings.h"
#include "paloc/core/map_matcher.h"
#include "paloc/core/pose.h"
#include "paloc/core/trajectory.h"

namespace paloc {

/// A node's scan and what the map said of it: kept until the whole recording is smoothed, so that
/// the scan can be associated anew from the better pose that it has then.
struct MapAssociation {
  std::shared_ptr<const Scan> scan;  ///< thinned; null if it was not kept
  Pose T_map_body_guess;             ///< where the search for correspondences began
  MapMatch match;
};

/// Keeps scans for later as long as there is memory for them; those that the map refused, or that
/// left a direction open, longer than those.
class PALOC_EXPORT KeptScans {
 public:
  /// `limit_mb`: megabytes of points, for scans of the first kind.
  explicit KeptScans(double limit_mb) : limit_mb_(limit_mb) {}

  /// A node's association: the match, its scan if there is one and room for it, and the guess.
  MapAssociation associate(const MapMatch& match, const Pose& T_map_body_guess);

 private:
  double limit_mb_, kept_mb_ = 0;
};

/// Matches the scan again from `T_map_body` if that lies further from the last guess than
/// EstimatorSettings::rematch_position_m or rematch_rotation_rad: a scan that was refused may be
/// used now, a free direction is held where the trajectory now is, and a match that no longer
/// agrees with the trajectory is withdrawn. `covariance` (6 x 6) is the pose's. True if the match
/// is a new one; `counts` are told.
PALOC_EXPORT bool associateAnew(MapMatcher& matcher, const EstimatorSettings& settings,
                                const Pose& T_map_body, const Mat6& covariance,
                                MapAssociation& association, RematchCounts& counts);

}  // namespace paloc

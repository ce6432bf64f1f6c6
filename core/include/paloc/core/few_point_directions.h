#pragma once

#include <vector>

#include "paloc/core/direction_information.h"
#include "paloc/core/export.h"
#include "paloc/core/map_matcher.h"
#include "paloc/core/pose.h"

namespace paloc {

/// Directions that a handful of a scan's points constrain, the axis of a corridor when its end
/// comes into view. Such points may be wrong together: matched with the wrong face of a door frame
/// they give a small residual and a small sigma at a place that is decimetres off, and where
/// nothing was known before, no prediction contradicts them. But they are wrong otherwise in the
/// next scan, while right ones agree. So what a scan says of such a direction counts once a few
/// scans in a row have agreed about it; until then it is withheld and the direction is classed as
/// open.
class PALOC_EXPORT FewPointDirections {
 public:
  /// Withholds what is not borne out yet from an accepted match, scan after scan. `T_map_body_last`
  /// and `T_map_body_predicted`: the estimate at the scan before and what it was carried on to.
  void check(const Pose& T_map_body_last, const Pose& T_map_body_predicted, MapMatch& match);
  /// A scan that says nothing: the next one stands alone.
  void forget() { seen_.clear(); }

 private:
  struct Seen {
    DirectionKind kind = DirectionKind::kPosition;
    Vec3 axis_map = Vec3::Zero();
    double sigma = 0;  // m or rad
    int scans = 0;     // in a row that agree
  };

  int scansAgreeing(const Seen& now, const Vec6& difference_map) const;

  std::vector<Seen> seen_;  // directions that the scan before knew
  Pose T_map_body_match_;   // where that was matched
};

}  // namespace paloc

#pragma once

#include "paloc/map/prior_map.h"
#include "ray_targets.h"

namespace paloc {

/// What the map shows about a place that it has nothing at.
class MapCoverage {
 public:
  /// `up`: unit, against gravity.
  MapCoverage(const PriorMap& map, const Vec3& up) : map_(map), up_(up) {}

  /// Whether the map shows a floor, the ground or a table top below a place: then it was surveyed,
  /// and what is there now is new.
  bool hasGroundBelow(const Vec3& p) const;

  /// Whether a plane of the map goes on through a target, beyond its border: then the survey did
  /// not see this part (a shadow, what stood before it), or left it out.
  bool continuesPlane(const RayTarget& target) const;

 private:
  const PriorMap& map_;
  Vec3 up_;
};

}  // namespace paloc

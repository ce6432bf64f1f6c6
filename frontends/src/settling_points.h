#pragma once

#include "paloc/frontends/plane_matches.h"
#include "points_on_planes.h"

namespace paloc {

/// PointsOnPlanes for a prediction that is off by decimetres, as one without an IMU can be.
///
/// While the pose is not sure, residuals are not either: by the widening of the kernel, which is
/// added to their variance. Many points are on wrong planes then (on a stair, on the next step),
/// and a direction that few points tell must not be moved by these from where the prediction has
/// it; it is left until the others are right (deterministic annealing, of the likelihood alone).
/// Without that a stairwell's height went to a local minimum a step away.
///
/// After a few steps at the end the points stay on the planes that they have. Points that change
/// planes from step to step made the last millimetres go on for ever.
template <int N, class Place>
class SettlingPoints : public PointsOnPlanes<N, Place> {
 public:
  SettlingPoints(PlaneMatches& matches, const LocalVoxelMap& map, double ageing, Place place)
      : PointsOnPlanes<N, Place>(matches, map, ageing, place), matches_(matches), place_(place) {}

  /// `least_voxel_m` is 0 once the pose is sure.
  template <class State>
  void associate(const State& x, double gate_m, double least_voxel_m) {
    if (least_voxel_m > 0 || ++sharp_ <= kAssociated) {
      PointsOnPlanes<N, Place>::associate(x, gate_m, least_voxel_m);
    } else {
      matches_.move(place_(x));
    }
  }
  void weigh(double widening_m) { matches_.weigh(widening_m, widening_m); }

 private:
  static constexpr int kAssociated = 4;  // steps

  PlaneMatches& matches_;
  Place place_;
  int sharp_ = 0;
};

template <int N, class Place>
SettlingPoints<N, Place> settlingPoints(PlaneMatches& matches, const LocalVoxelMap& map,
                                        double ageing, Place place) {
  return {matches, map, ageing, place};
}

}  // namespace paloc

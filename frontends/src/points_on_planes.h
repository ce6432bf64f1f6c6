#pragma once

#include "paloc/frontends/plane_matches.h"

namespace paloc {

/// The points of a scan on the planes of a local map, as an IteratedUpdate asks for them; N as of
/// PointToPlaneSums. `place(x)` gives the points where the state x puts them; `ageing` as of
/// jacobianOf.
template <int N, class Place>
class PointsOnPlanes {
 public:
  PointsOnPlanes(PlaneMatches& matches, const LocalVoxelMap& map, double ageing, Place place)
      : matches_(matches), map_(map), ageing_(ageing), place_(place) {}

  template <class State>
  void associate(const State& x, double gate_m, double least_voxel_m) {
    matches_.associate(place_(x), map_, gate_m, least_voxel_m);
  }
  std::size_t size() const { return matches_.size(); }
  void weigh(double widening_m) { matches_.weigh(widening_m); }
  PointToPlaneSums<N> sums() const { return matches_.template sums<N>(ageing_); }
  Eigen::Matrix<double, N, N> normalNoise() const {
    return matches_.template normalNoise<N>(ageing_);
  }

 private:
  PlaneMatches& matches_;
  const LocalVoxelMap& map_;
  double ageing_;
  Place place_;
};

template <int N, class Place>
PointsOnPlanes<N, Place> pointsOnPlanes(PlaneMatches& matches, const LocalVoxelMap& map,
                                        double ageing, Place place) {
  return {matches, map, ageing, place};
}

}  // namespace paloc

#pragma once

#include <array>
#include <vector>

#include "paloc/core/pose.h"
#include "paloc/map/degeneracy.h"
#include "paloc/map/map_information.h"

namespace paloc {

/// Directions that are held at the start, as rows of a prior.
class Anchors {
 public:
  /// Those of the observed ones that the map does not fix.
  void hold(const std::array<MatchDirection, 6>& directions);
  void addTo(NormalEquations& equations, const Vec6& from_start) const;

 private:
  std::vector<Vec6> axes_;
};

/// The Gauss-Newton step in the tangent of PlaneRow, no longer than is believed (0.5 m, 0.2 rad);
/// false when there is none.
bool solveStep(const NormalEquations& equations, Vec6& step);

}  // namespace paloc

#pragma once

#include <vector>

#include "paloc/map/occupancy_pyramid.h"
#include "paloc/map/search_points.h"

namespace paloc {

/// A map as the search sees it: what stands up, and everything.
struct SearchMap {
  GridFrame frame;
  OccupancyPyramid upright, all;
};

/// Where to search: positions of the body (map-local, m) and headings, by which the level frame of
/// the points is turned about the vertical (rad).
struct SearchBox {
  Vec3 low = Vec3::Zero(), high = Vec3::Zero();
  double yaw_low = 0, yaw_high = 0;
};

/// What a search may cost and what it may leave out.
struct SearchLimits {
  double min_share = 0.6;      ///< of the points in occupied cells: poses with fewer are no answer
  double max_mlookups = 4000;  ///< million look-ups in the grids
  std::size_t candidates = 12;
  int threads = 1;  ///< no influence on the result
};

/// A pose that many points fit, to half a cell and half a step of heading.
struct StartCandidate {
  Vec3 position = Vec3::Zero();  ///< of the body, map-local (m)
  double yaw = 0;                ///< rad, see SearchBox
  int hits = 0;                  ///< points in occupied cells
};

/// What a search came to.
struct StartCandidates {
  std::vector<StartCandidate>
      found;             ///< the best first, each a metre or ten degrees from all others
  bool finished = true;  ///< false: given up, there may be better ones
};

/// Finds the poses that put the most points into occupied cells, by branch and bound over positions
/// and headings (after Hess et al. 2016): a cube of positions cannot score more than its look-ups
/// in the pyramid's level of its size say, so what is worse than the candidates already found is
/// never looked into. Exhaustive, to the grid's resolution, unless given up. Deterministic.
PALOC_EXPORT StartCandidates searchStarts(const SearchMap& map, const SearchPoints& points,
                                          const SearchBox& box, const SearchLimits& limits);

}  // namespace paloc

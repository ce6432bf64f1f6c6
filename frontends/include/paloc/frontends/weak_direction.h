#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "paloc/core/export.h"
#include "paloc/frontends/local_voxel_map.h"
#include "paloc/frontends/plane_matches.h"

namespace paloc {

/// The direction in which the points of a scan tell a position least.
struct WeakDirection {
  Vec3 axis = Vec3::UnitZ();  ///< unit
  double missing = 0;         ///< points with a normal along it, until it has a tenth of all
};

/// Where fewer than a tenth of the points tell a direction (a third is even); `normals` is the sum
/// of n n^T over their normals.
PALOC_EXPORT std::optional<WeakDirection> weakDirection(const Mat3& normals);

/// Further points that tell it: those on a plane of the map that faces it, except every `step`-th,
/// which is used already; evenly chosen, about as many as are missing. So a direction that few
/// surfaces tell is told by all points on these (after N. Gelfand et al., "Geometrically Stable
/// Sampling for the ICP Algorithm", 2003): of the height in a stairwell some 30 of 3000 tell, of
/// all the scan's points 200.
PALOC_EXPORT std::vector<std::uint32_t> pointsThatTell(const WeakDirection& direction,
                                                       std::span<const PlacedPoint> points,
                                                       std::size_t step, const LocalVoxelMap& map);

}  // namespace paloc

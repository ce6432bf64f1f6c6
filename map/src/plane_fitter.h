#pragma once

#include <tbb/task_arena.h>

#include "paloc/map/map_settings.h"
#include "plane_store.h"
#include "point_index.h"

namespace paloc {

/// The plane about every point of a map (see fitPlane). The neighbourhoods follow the density of
/// the map: they reach as far as the `plane_neighbours`-th neighbour of the middle point of each
/// block of eight, at most `plane_max_radius_m`. Points of a block that lie on one clean surface
/// share its plane. Where the surface is one face
/// of a thin wall, its normal is turned to the side from which it is seen. The same on any number
/// of threads.
PlaneStore fitPlanes(const PointIndex& index, const MapSettings& settings, tbb::task_arena& arena);

}  // namespace paloc

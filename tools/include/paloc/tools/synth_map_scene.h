#pragma once

#include <filesystem>

#include "paloc/map/octree_map.h"
#include "paloc/tools/synth_scene.h"

namespace paloc::synth {

/// A scene out of an OctoMap file (.bt, .ot): its surfaces and, if `with_route`, a way to walk in
/// it. There are no survey stations: the file is the prior map. Throws IoError for a file that
/// cannot be read, UsageError when no way is found.
Scene makeMapScene(const std::filesystem::path& file, bool with_route);

/// The surfaces of occupied space, where readers of such a map take them to be: half a cell behind
/// the faces of the occupied cells (see loadCloud). The faces of cells, each corner moved inwards
/// by half a cell along the normal of every face that meets there, so that the surface stays
/// closed, flat walls stay flat, and a wall one cell thick becomes a sheet.
SceneMesh meshOf(const OctreeMap& map);

/// A closed way out and back through known free space, on one level, at least half a metre from
/// whatever is occupied: the longest of the shortest ways. z is such that a body carried as in
/// makeWalk stays at that level, if possible at the height of a chest above the floor. Throws
/// UsageError when there is none of at least 5 m.
std::vector<Vec3> routeThrough(const OctreeMap& map);

}  // namespace paloc::synth

#pragma once

#include "paloc/tools/synth_mesh.h"
#include "paloc/tools/synth_random.h"

namespace paloc::synth {

/// One of the pieces that stand along a wall, picked at random, in its frame (synth_furniture.h).
void addPieceByTheWall(MeshBuilder& builder, const Pose& T_scene_piece, RandomStream& random);

/// Furnishes a room between the middles of its walls (scene frame, m; the floor at z = 0), 4 m wide
/// at least: a table with chairs, and pieces along the four walls, which may stand before doors.
void furnishRoom(MeshBuilder& builder, const Vec3& low, const Vec3& high, RandomStream& random);

}  // namespace paloc::synth

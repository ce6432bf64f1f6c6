#pragma once

#include <tbb/task_arena.h>

#include "plane_store.h"
#include "point_index.h"

namespace paloc {

/// Turns the planes that are one face of a thin wall (3 to 30 cm) towards the side from which the
/// face is seen, away from the other face. A face counts as one of a wall only where another,
/// parallel one lies behind it at its place and about it, and none in front: the tread of a step or
/// the floor by a piece of furniture does not. The same on any number of threads.
void turnFacesToTheirViewers(const PointIndex& index, PlaneStore& planes, tbb::task_arena& arena);

}  // namespace paloc

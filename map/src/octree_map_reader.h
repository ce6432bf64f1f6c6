#pragma once

#include "input_file.h"
#include "memory_budget.h"
#include "paloc/map/octree_map.h"

namespace paloc {

/// Reads OctoMap's .bt or .ot; which of them its first line tells. Throws IoError.
OctreeMap readOctreeMap(const InputFile& file, const MemoryBudget& budget);

}  // namespace paloc

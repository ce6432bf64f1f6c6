#pragma once

#include <tbb/task_arena.h>

#include <string>

#include "paloc/map/point_block.h"
#include "paloc/map/point_cloud.h"
#include "raw_array.h"

namespace paloc {

/// The edge of the voxels that the curve of thinAlongCurve() goes through (m).
double curveVoxel(double voxel_m);

/// Points in blocks; lanes of the last one behind the last point are missing.
struct BlockedPoints {
  RawArray<PointBlock> blocks;
  std::size_t count = 0;
};

/// The points of a cloud along a Hilbert curve through voxels of this edge, those of one voxel
/// replaced by their centroid (voxel_m = 0: all kept, as they are). Neighbours in space are near in
/// memory, for the sake of every later search. Throws IoError (with `name`) when the cloud spans
/// more than 2^21 voxels.
BlockedPoints thinAlongCurve(const PointCloud& cloud, double voxel_m, tbb::task_arena& arena,
                             const std::string& name);

}  // namespace paloc

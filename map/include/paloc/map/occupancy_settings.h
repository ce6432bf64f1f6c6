#pragma once

namespace paloc {

/// Settings of the occupancy map that is made of the scans.
struct OccupancySettings {
  double resolution_m = 0.1;    ///< edge of a cell
  double max_range_m = 30;      ///< a longer ray tells of free space up to here, of no surface
  double max_memory_mb = 2000;  ///< of the octree: once it is larger, no further scan is put in
};

}  // namespace paloc

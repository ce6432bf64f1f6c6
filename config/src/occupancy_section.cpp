#include "section.h"

namespace paloc {

std::vector<Setting> occupancySettings() {
  using S = OccupancySettings;
  Section s(
      "octomap", [](auto& config) -> auto& { return config.octomap; });
  s.number("resolution_m", &S::resolution_m, "m", {0.01, 10}, "Edge of a cell of octomap.bt.");
  s.number("max_range_m", &S::max_range_m, "m", {1, 1000},
           "A longer ray tells of free space up to here, and of no surface.");
  s.number("max_memory_mb", &S::max_memory_mb, "MB", {1, 1e6},
           "Of the octree: once it is larger, no further scan is put in, and that is told.");
  return std::move(s).rows();
}

}  // namespace paloc

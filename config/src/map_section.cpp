#include "section.h"

namespace paloc {

std::vector<Setting> mapSettings() {
  using S = MapSettings;
  Section s(
      "map", [](auto& config) -> auto& { return config.map; });
  s.number("voxel_m", &S::voxel_m, "m", {0, 10},
           "The map is thinned to this on loading; 0 keeps every point.");
  s.count("plane_neighbours", &S::plane_neighbours, {4, 200}, "Points that a plane is fitted to.");
  s.number("plane_max_radius_m", &S::plane_max_radius_m, "m", {0.01, 10},
           "None of them lies further away than this.");
  s.number("plane_max_thickness_m", &S::plane_max_thickness_m, "m", {1e-4, 1},
           "A patch whose standard deviation across the plane exceeds this is not planar.");
  s.flag("side_file", &S::side_file,
         "Keep planes and index in the file MAP.paloc beside the map, for the next start.");
  s.count("threads", &S::threads, {1, 64},
          "Threads that fit the planes; no influence on the result.");
  return std::move(s).rows();
}

}  // namespace paloc

#pragma once

namespace paloc {

/// Settings of the prior map: how its planes are fitted.
struct MapSettings {
  double voxel_m = 0.05;            ///< the map is thinned to this on loading; 0 keeps every point
  int plane_neighbours = 20;        ///< points a plane is fitted to
  double plane_max_radius_m = 0.4;  ///< none of them further away
  double plane_max_thickness_m = 0.08;  ///< standard deviation across the plane, above: not planar
  bool side_file = true;  ///< keep what was prepared in the file MAP.paloc beside the map
  int threads = 2;
};

}  // namespace paloc

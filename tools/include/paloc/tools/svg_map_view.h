#pragma once

#include <string>
#include <vector>

#include "paloc/core/trajectory.h"
#include "paloc/core/types.h"
#include "paloc/tools/svg_axes.h"

namespace paloc {

/// A view of trajectory and map along one axis of the map frame.
struct MapView {
  std::string title;   ///< "From above"
  int right_axis = 0;  ///< 0 x, 1 y, 2 z of the map frame
  int up_axis = 1;
  double min_aspect = 0.3;  ///< height over width of the picture
  double max_aspect = 0.75;
};

/// The figure: the map as a pale picture of the density of its points, the trajectory coloured by
/// flag, its start and end, axes (m) and a scale bar. Either may be empty. Map points are relative
/// to `map_origin` (m, map frame).
std::string mapViewFigure(const MapView& view, const std::vector<TrajectoryPoint>& trajectory,
                          const std::vector<Point3f>& map_points, const Vec3& map_origin);

}  // namespace paloc

#pragma once

#include <cstdint>

namespace paloc {

/// The plane that the surface about one map point was found to be.
struct MapPlane {
  float nx = 0, ny = 0, nz = 0;  ///< unit normal in the map
  float offset_m = 0;          ///< n . (centroid - point): the plane is n . (x - point) = offset_m
  float thickness_m = 0;       ///< standard deviation of its points across it; < 0: not planar
  float normal_sigma_rad = 0;  ///< standard deviation of the normal's direction
  std::uint32_t points = 0;    ///< that it was fitted to
  /// Whether the normal points to the side from which the surface is seen: where another face lies
  /// a wall's thickness behind it. Else the normal's sign has no meaning.
  bool oriented = false;

  bool planar() const { return thickness_m >= 0; }
  bool operator==(const MapPlane&) const = default;
};

/// When a neighbourhood counts as a plane.
struct PlaneFitLimits {
  double max_thickness_m = 0.04;  ///< standard deviation across, above: not planar
  /// Standard deviation that the points of one surface have anyway: above it, the fit is repeated
  /// without what lies off, and split where there is a gap.
  double clean_thickness_m = 0.004;
  int min_points = 6;
};

}  // namespace paloc

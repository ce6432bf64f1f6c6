#pragma once

#include <cstdint>
#include <span>

#include "paloc/core/export.h"
#include "paloc/core/types.h"

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

/// Fits a plane to the neighbours of a point (given relative to it, the point itself included, m)
/// by principal components. Where they lie thicker than one clean surface: the two faces of a thin
/// wall are told apart by the gap between them, the face of the point itself is kept, and the fit
/// is repeated without what lies off it. Not planar: too few points, too thick, a line, an edge or
/// a bush (thickness against width), or a point that lies off the plane of its own neighbours. The
/// first half of the neighbours must be the nearer one. `scratch` is work space of at least the
/// size of `relative`.
PALOC_EXPORT MapPlane fitPlane(std::span<const Point3f> relative, const PlaneFitLimits& limits,
                               std::span<float> scratch);

}  // namespace paloc

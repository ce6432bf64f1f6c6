#pragma once

#include <span>
#include <vector>

#include "paloc/core/export.h"
#include "paloc/core/types.h"

namespace paloc {

/// The surface that a thinned scan itself shows about some of its points, without any map.
class PALOC_EXPORT ScanNormals {
 public:
  /// The points of a thinned scan (m), which may go afterwards.
  explicit ScanNormals(std::span<const Point3f> points);

  /// The radius within which most points have about so many neighbours (m): a scan that is thinned
  /// evenly over its surfaces has one density.
  double radiusFor(std::size_t neighbours) const;

  /// Unit normal, of no particular sign, of the plane through the scan's points within `radius_m`
  /// of a point; zero where they are fewer than six or lie on no plane (a line, an edge, a bush).
  Vec3 at(const Point3f& point, double radius_m) const;

 private:
  std::size_t countNear(std::size_t point, double radius_m) const;

  // Side by side, so that four are tried at once; filled up with what lies too far away. A few
  // hundred passes over some thousand points cost less than an index over them.
  std::vector<float> x_, y_, z_;
  std::size_t size_ = 0;
};

}  // namespace paloc

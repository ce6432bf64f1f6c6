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
  std::size_t countNear(const Point3f& point, double radius_m) const;
  template <typename Visit>
  void visitNear(const Point3f& point, double radius_m, const Visit& visit) const;

  // Side by side, so that four are tried at once; filled up with what lies too far away. Points
  // that follow each other in a scan lie near to each other: a few hundred passes over the boxes
  // about every sixteen of them cost less than an index.
  std::vector<float> x_, y_, z_;
  std::vector<float> low_[3], high_[3];  // of the boxes
  std::size_t size_ = 0;
};

}  // namespace paloc

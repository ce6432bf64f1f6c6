#pragma once

#include <cstdint>
#include <nanoflann.hpp>
#include <vector>

#include "paloc/core/types.h"

namespace paloc {

/// nanoflann's view of a vector of points.
struct PointAdaptor {
  const std::vector<Point3f>& points;

  // NOLINTBEGIN(readability-identifier-naming): nanoflann calls them so
  std::size_t kdtree_get_point_count() const { return points.size(); }
  float kdtree_get_pt(std::size_t index, std::size_t dim) const {
    const Point3f& p = points[index];
    return dim == 0 ? p.x : dim == 1 ? p.y : p.z;
  }
  template <typename Box>
  bool kdtree_get_bbox(Box&) const {
    return false;
  }
  // NOLINTEND(readability-identifier-naming)
};

using KdTree = nanoflann::KDTreeSingleIndexAdaptor<
    nanoflann::L2_Simple_Adaptor<float, PointAdaptor, float, std::uint32_t>, PointAdaptor, 3,
    std::uint32_t>;

}  // namespace paloc

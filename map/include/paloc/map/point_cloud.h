#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "paloc/core/types.h"

namespace paloc {

/// A point cloud with an origin in double precision, so that UTM coordinates keep their
/// millimetres: p = origin + points[i]. All points are finite.
struct PointCloud {
  std::string format;               ///< of the file that it was read from; empty if it was not
  Vec3 origin = Vec3::Zero();       ///< m, in the cloud's frame
  std::vector<Point3f> points;      ///< m, relative to `origin`
  std::vector<float> intensity;     ///< empty, or one per point
  std::vector<std::uint16_t> ring;  ///< empty, or one per point: the laser that saw it
  /// Empty, or one per point: the raw value of the file's time field, in the field's own unit.
  std::vector<double> time;
  std::string time_field;  ///< the name of that field ("t", "timestamp"); empty if there is none
  bool time_is_integer = false;       ///< whether the file stores it as an integer
  std::size_t points_read = 0;        ///< finite points of the file, before any thinning
  std::size_t nonfinite_dropped = 0;  ///< points that were not finite and were left out

  std::size_t size() const { return points.size(); }
  bool empty() const { return points.empty(); }
};

}  // namespace paloc

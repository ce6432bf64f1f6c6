#pragma once

#include <cstddef>
#include <vector>

#include "paloc/core/time.h"
#include "paloc/core/types.h"

namespace paloc {

/// A scan as the rays that it was measured by, placed in the map. Coordinates (m) are relative to
/// the origin that its source tells, so that UTM coordinates keep their millimetres.
struct ScanRays {
  TimeNs t_ns = 0;
  std::vector<Point3f> from;  ///< where the sensor was, one per ray
  std::vector<Point3f> to;    ///< what the ray met
  /// Standard deviations of the pose that placed them, each along its worst direction.
  double position_sigma_m = 0, rotation_sigma_rad = 0;
};

/// Port: the scans of a recording in order of time. They are asked for one by one, and perhaps
/// again, since all rays at once may not fit in memory.
class ScanRaySource {
 public:
  virtual ~ScanRaySource() = default;
  virtual std::size_t size() const = 0;
  virtual Vec3 origin() const = 0;  ///< of all rays (m, in the map frame)
  /// The `index`-th scan; may be called from several threads at a time.
  virtual ScanRays rays(std::size_t index) const = 0;
};

}  // namespace paloc

#pragma once

#include <cstddef>

#include "paloc/core/export.h"
#include "paloc/core/scan.h"
#include "paloc/frontends/lidar_frame.h"
#include "paloc/frontends/scan_motion.h"

namespace paloc {

/// Ranges (m, from the sensor) of the returns that are kept.
struct RangeLimits {
  double min_m = 0.5;
  double max_m = 120.0;
};

/// Returns that were left out of a scan.
struct DroppedPoints {
  std::size_t too_near = 0;
  std::size_t too_far = 0;
};

/// The scan in the body frame at its end, each point moved by the motion since its own time. The
/// motion is sampled evenly, so densely that taking it as linear between samples moves no point
/// within range by more than 0.1 mm. The frame's points must have times.
PALOC_EXPORT Scan deskew(const LidarFrame& frame, const ScanMotion& motion, RangeLimits limits,
                         DroppedPoints& dropped);

/// The scan in the body frame as it is, without undoing any motion.
PALOC_EXPORT Scan placeOnBody(const LidarFrame& frame, RangeLimits limits, DroppedPoints& dropped);

}  // namespace paloc

#pragma once

#include <memory>

#include "paloc/core/scan.h"
#include "paloc/core/unused_counts.h"
#include "paloc/frontends/deskew.h"

namespace paloc {

/// Whether the body may have moved while the points of a scan, as it comes, were measured.
inline bool isSkewed(const LidarFrame& frame) { return frame.duration_ns > 0 && !frame.deskewed; }

/// The estimator's scan of a LiDAR's: deskewed by `motion`, or as it is where that is null. Points
/// left out are counted; null, with its reason counted, if none is left. A scan deskewed by an IMU
/// says with which velocity (Scan::v_body_assumed), others what is left in them of the motion
/// (Scan::skew).
std::shared_ptr<const Scan> makeScan(const LidarFrame& frame, const ScanMotion* motion,
                                     RangeLimits limits, UnusedCounts& unused);

}  // namespace paloc

#pragma once

#include <memory>

#include "paloc/core/scan.h"
#include "paloc/core/unused_counts.h"
#include "paloc/frontends/deskew.h"

namespace paloc {

/// The estimator's scan of a LiDAR's: deskewed by `motion`, or as it is where that is null. Points
/// left out are counted; null, with its reason counted, if none is left.
std::shared_ptr<Scan> makeScan(const LidarFrame& frame, const ScanMotion* motion,
                               RangeLimits limits, UnusedCounts& unused);

}  // namespace paloc

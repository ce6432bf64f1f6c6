#pragma once

#include <string>

#include "paloc/core/export.h"
#include "paloc/frontends/finding.h"
#include "paloc/map/point_cloud.h"

namespace paloc {

/// Whether a prior map can be in metres, by its size and how dense it is, against how far the scans
/// reach (m, 0 if not known). Tells factors of a hundred and more (millimetres, centimetres,
/// kilometres); a map in feet it cannot tell from a larger place.
PALOC_EXPORT Findings checkMapScale(const PointCloud& map, const std::string& name,
                                    double scan_reach_m);

}  // namespace paloc

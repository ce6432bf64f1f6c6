#pragma once

#include <optional>
#include <vector>

#include "paloc/core/export.h"
#include "paloc/core/types.h"

namespace paloc {

/// Which way is up in a scan (unit vector, body frame), from its own surfaces: most of what is
/// built stands upright or lies level. `up_body` is a first idea, right to some 20 degrees. Nothing
/// where too little of the scan is flat.
PALOC_EXPORT std::optional<Vec3> levelOfScan(const std::vector<Point3f>& points_body,
                                             const Vec3& up_body);

}  // namespace paloc

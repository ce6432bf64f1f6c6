#pragma once

#include <span>
#include <vector>

#include "paloc/frontends/free_fall_scan.h"
#include "paloc/frontends/lio_calibration.h"
#include "paloc/frontends/lio_state.h"
#include "paloc/frontends/measured_point.h"
#include "paloc/frontends/plane_matches.h"

namespace paloc {

/// Where a state at the end of a scan puts its points. `ageing` is 0 where the scan's distortion is
/// to be left as it is, as if the velocity were zero in free fall, else 1.
PALOC_EXPORT void placePoints(std::span<const MeasuredPoint> points, const FreeFallScan& scan,
                              const Vec3& sensor_body, const LioState& x, double ageing,
                              std::vector<PlacedPoint>& placed);

/// The same with a calibration. What is left of the time offset moves the points to first order.
PALOC_EXPORT void placePoints(std::span<const MeasuredPoint> points, const FreeFallScan& scan,
                              const Vec3& sensor_body, const CalibratedLioState& s, double ageing,
                              std::vector<PlacedPoint>& placed);

}  // namespace paloc

#include "paloc/core/pose_flags.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace paloc {
namespace {

// Seconds from each point to the nearest one with a map factor.
std::vector<double> timeToMapFactor(const std::vector<bool>& has_map_factor,
                                    const std::vector<TrajectoryPoint>& points) {
  std::vector<double> result(points.size(), std::numeric_limits<double>::infinity());
  std::ptrdiff_t last = -1;
  const auto count = static_cast<std::ptrdiff_t>(points.size());
  const auto pass = [&](std::ptrdiff_t k) {
    const auto u = static_cast<std::size_t>(k);
    if (has_map_factor[u]) last = k;
    if (last < 0) return;
    const double dt = secondsBetween(points[static_cast<std::size_t>(last)].t_ns, points[u].t_ns);
    result[u] = std::min(result[u], std::abs(dt));
  };
  for (std::ptrdiff_t k = 0; k < count; ++k) pass(k);
  last = -1;
  for (std::ptrdiff_t k = count; k-- > 0;) pass(k);
  return result;
}

}  // namespace

void setPoseFlags(const std::vector<bool>& has_map_factor, const EstimatorSettings& settings,
                  std::vector<TrajectoryPoint>& points) {
  const std::vector<double> away_s = timeToMapFactor(has_map_factor, points);
  for (std::size_t k = 0; k < points.size(); ++k) {
    TrajectoryPoint& point = points[k];
    const double variance = point.covariance.diagonal().head<3>().maxCoeff();
    const bool all_full =
        std::all_of(point.directions.begin(), point.directions.end(),
                    [](const MatchDirection& d) { return d.cls == DirectionClass::kFull; });
    if (!(std::sqrt(variance) <= settings.lost_sigma_position_m)) {
      point.flag = PoseFlag::kLost;
    } else if (away_s[k] > settings.coasting_after_s) {
      point.flag = PoseFlag::kCoasting;
    } else if (has_map_factor[k] && !all_full) {
      point.flag = PoseFlag::kDegenerate;
    } else {
      point.flag = PoseFlag::kGood;
    }
  }
}

}  // namespace paloc

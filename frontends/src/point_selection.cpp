#include "paloc/frontends/point_selection.h"

#include <algorithm>

namespace paloc {

void PointSelection::select(const LidarFrame& frame, bool has_times, std::size_t wanted,
                            const std::vector<std::uint32_t>* indices,
                            std::vector<MeasuredPoint>& selected) {
  selected.clear();
  candidates_.clear();
  if (indices) {
    for (const std::uint32_t i : *indices) candidates_.push_back(frame.points_lidar[i]);
  }
  const std::vector<Point3f>& points = indices ? candidates_ : frame.points_lidar;
  for (const std::uint32_t k : thinning_.select(points, Vec3::Zero(), wanted)) {
    add(frame, has_times, indices ? (*indices)[k] : k, selected);
  }
}

void PointSelection::selectAll(const LidarFrame& frame, bool has_times,
                               const std::vector<std::uint32_t>& indices,
                               std::vector<MeasuredPoint>& selected) {
  selected.clear();
  for (const std::uint32_t i : indices) add(frame, has_times, i, selected);
}

// Unless it is out of range.
void PointSelection::add(const LidarFrame& frame, bool has_times, std::uint32_t index,
                         std::vector<MeasuredPoint>& selected) const {
  const Point3f& p = frame.points_lidar[index];
  const Vec3 point(static_cast<double>(p.x), static_cast<double>(p.y), static_cast<double>(p.z));
  const double sq = point.squaredNorm();
  if (sq < settings_.min_range_m * settings_.min_range_m ||
      sq > settings_.max_range_m * settings_.max_range_m) {
    return;
  }
  const double age_s =
      has_times ? secondsBetween(static_cast<TimeNs>(frame.dt_ns[index]), frame.duration_ns) : 0;
  selected.push_back({frame.T_body_lidar * point, age_s});
}

// An odd step: scans come column by column, and one that divides the number of rings would take
// the same rings again and again.
std::size_t stepOf(std::size_t points, std::size_t wanted) {
  return ((points + wanted / 2) / wanted) | 1U;
}

std::vector<MeasuredPoint> everyNth(const std::vector<MeasuredPoint>& points, std::size_t wanted) {
  const std::size_t step = stepOf(points.size(), wanted);
  std::vector<MeasuredPoint> result;
  for (std::size_t i = 0; i < points.size(); i += step) result.push_back(points[i]);
  return result;
}

}  // namespace paloc

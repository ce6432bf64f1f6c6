#include "paloc/tools/scan_map.h"

#include <algorithm>

#include "paloc/core/mrpt_pose.h"
#include "paloc/map/voxel_filter.h"

namespace paloc {
namespace {

constexpr double kKeepEveryMetres = 0.2;
constexpr double kKeepEveryRadians = 0.2;
constexpr double kKeepEverySeconds = 2.0;
constexpr std::size_t kPointsPerScan = 8000;

}  // namespace

void ScanMap::add(const OdometryFrame& frame) {
  if (!frame.scan || frame.scan->points_body.empty()) return;
  const Pose T_odom_body = fromMrpt(frame.T_odom_body);
  const Vec6 step = boxminus(T_odom_body, T_odom_body_kept_);
  const bool moved = step.head<3>().norm() > kKeepEveryMetres ||
                     step.tail<3>().norm() > kKeepEveryRadians ||
                     secondsBetween(t_kept_ns_, frame.t_ns) > kKeepEverySeconds;
  if (!scans_.empty() && !moved) return;
  T_odom_body_kept_ = T_odom_body;
  t_kept_ns_ = frame.t_ns;

  const std::vector<Point3f>& points = frame.scan->points_body;
  const std::size_t stride = std::max<std::size_t>(1, points.size() / kPointsPerScan);
  ThinScan thin{frame.t_ns, {}, {}, frame.scan->sensor_position_body};
  thin.points_body.reserve(points.size() / stride + 1);
  const bool keep_ages = keep_ages_ && !frame.scan->ages_s.empty();
  // A different phase for each scan, so that the same rays are not left out every time.
  for (std::size_t k = scans_.size() % stride; k < points.size(); k += stride) {
    thin.points_body.push_back(points[k]);
    if (keep_ages) thin.ages_s.push_back(frame.scan->ages_s[k]);
  }
  scans_.push_back(std::move(thin));
}

PointCloud ScanMap::build(const std::vector<TrajectoryPoint>& trajectory, double voxel_m) const {
  PointCloud cloud;
  if (!trajectory.empty()) cloud.origin = fromMrpt(trajectory.front().T_map_body).position;
  for (const ThinScan& scan : scans_) {
    const TrajectoryPoint* at = usablePoint(trajectory, scan.t_ns);
    if (!at) continue;
    const Pose T_map_body = fromMrpt(at->T_map_body);
    const Eigen::Matrix3f rotation = T_map_body.rotation.cast<float>();
    const Eigen::Vector3f position = (T_map_body.position - cloud.origin).cast<float>();
    for (const Point3f& p : scan.points_body) {
      const Eigen::Vector3f q = rotation * Eigen::Vector3f(p.x, p.y, p.z) + position;
      cloud.points.push_back({q.x(), q.y(), q.z()});
    }
  }
  if (cloud.points.empty()) return cloud;
  VoxelFilter filter;
  std::vector<Point3f> kept;
  for (const std::uint32_t index : filter.select(cloud.points, voxel_m)) {
    kept.push_back(cloud.points[index]);
  }
  cloud.points.swap(kept);
  return cloud;
}

const TrajectoryPoint* usablePoint(const std::vector<TrajectoryPoint>& trajectory, TimeNs t_ns) {
  const auto at =
      std::lower_bound(trajectory.begin(), trajectory.end(), t_ns,
                       [](const TrajectoryPoint& point, TimeNs t) { return point.t_ns < t; });
  const bool usable = at != trajectory.end() && at->t_ns == t_ns && at->flag != PoseFlag::kLost;
  return usable ? &*at : nullptr;
}

}  // namespace paloc

#include "paloc/tools/placed_scans.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "paloc/core/mrpt_pose.h"

namespace paloc {
namespace {

double largestSigma(const Mat3& covariance) {
  const Eigen::SelfAdjointEigenSolver<Mat3> solver(covariance, Eigen::EigenvaluesOnly);
  return std::sqrt(std::max(solver.eigenvalues().maxCoeff(), 0.0));
}

Point3f toPoint(const Eigen::Vector3f& v) { return {v.x(), v.y(), v.z()}; }

}  // namespace

PlacedScans::PlacedScans(const ScanMap& scans, const std::vector<TrajectoryPoint>& trajectory,
                         const Vec3& origin)
    : origin_(origin) {
  for (const ScanMap::ThinScan& scan : scans.scans()) {
    if (const TrajectoryPoint* at = usablePoint(trajectory, scan.t_ns)) {
      placed_.push_back({&scan, at});
    }
  }
}

// The sensor moved during the scan: its points are deskewed to the end, but each ray began where it
// was at the ray's own time. At a walk that is up to a decimetre away. Over so short a time its
// speed is taken as even.
ScanRays PlacedScans::rays(std::size_t index) const {
  const auto& [scan, at] = placed_[index];
  const Pose T_map_body = fromMrpt(at->T_map_body);
  const Eigen::Matrix3f rotation = T_map_body.rotation.cast<float>();
  const Eigen::Vector3f position = (T_map_body.position - origin_).cast<float>();
  const Eigen::Vector3f sensor = (T_map_body * scan->sensor_position_body - origin_).cast<float>();
  const Eigen::Vector3f velocity = at->v_map.cast<float>();
  ScanRays rays;
  rays.t_ns = scan->t_ns;
  rays.position_sigma_m = largestSigma(at->covariance.topLeftCorner<3, 3>());
  rays.rotation_sigma_rad = largestSigma(at->covariance.bottomRightCorner<3, 3>());
  rays.from.assign(scan->points_body.size(), toPoint(sensor));
  for (std::size_t i = 0; i < scan->ages_s.size(); ++i) {
    rays.from[i] = toPoint(sensor - scan->ages_s[i] * velocity);
  }
  for (const Point3f& p : scan->points_body) {
    rays.to.push_back(toPoint(rotation * Eigen::Vector3f(p.x, p.y, p.z) + position));
  }
  return rays;
}

}  // namespace paloc

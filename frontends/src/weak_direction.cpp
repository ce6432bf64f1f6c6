#include "paloc/frontends/weak_direction.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace paloc {
namespace {

constexpr double kLeastShare = 0.1;
constexpr double kFacing = 0.5;        // cosine between normal and axis, at least
constexpr double kMaxHeight = 0.1;     // m, over the plane
constexpr double kMaxLeverFactor = 8;  // further from its points a plane is a guess

}  // namespace

std::optional<WeakDirection> weakDirection(const Mat3& normals) {
  Eigen::SelfAdjointEigenSolver<Mat3> solver;
  solver.computeDirect(normals);
  const double missing = kLeastShare * normals.trace() - solver.eigenvalues()[0];
  if (!(missing > 0)) return std::nullopt;
  return WeakDirection{solver.eigenvectors().col(0), missing};
}

std::vector<std::uint32_t> pointsThatTell(const WeakDirection& direction,
                                          std::span<const PlacedPoint> points, std::size_t step,
                                          const LocalVoxelMap& map) {
  std::vector<std::uint32_t> facing;
  LocalPlane plane;
  for (std::uint32_t i = 0; i < points.size(); ++i) {
    const PlacedPoint& p = points[i];
    if (i % step == 0 || !map.find(p.point_odom, p.ray, plane)) continue;
    if (std::abs(plane.normal.dot(direction.axis)) < kFacing) continue;
    if (std::abs(plane.height(p.point_odom)) > kMaxHeight) continue;
    if (plane.leverFactor(p.point_odom) > kMaxLeverFactor) continue;
    facing.push_back(i);
  }
  const double every = std::max(1.0, static_cast<double>(facing.size()) / direction.missing);
  std::vector<std::uint32_t> chosen;
  for (double at = 0; at < static_cast<double>(facing.size()); at += every) {
    chosen.push_back(facing[static_cast<std::size_t>(at)]);
  }
  return chosen;
}

}  // namespace paloc

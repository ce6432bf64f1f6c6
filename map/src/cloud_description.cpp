#include "paloc/map/cloud_description.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "kd_tree.h"
#include "paloc/core/errors.h"

namespace paloc {
namespace {

constexpr std::size_t kSampled = 5000;
constexpr std::size_t kNeighbours = 8;  // so many points at the same place are seen through
constexpr std::size_t kLeafPoints = 10;

// The distance to the nearest point that is not at the same place; 0 if there is none near.
float distanceToNext(const KdTree& tree, const Point3f& point) {
  std::array<std::uint32_t, kNeighbours> indices{};
  std::array<float, kNeighbours> distances_sq{};
  const std::size_t found =
      tree.knnSearch(&point.x, kNeighbours, indices.data(), distances_sq.data());
  for (std::size_t i = 0; i < found; ++i) {
    if (distances_sq[i] > 0) return std::sqrt(distances_sq[i]);
  }
  return 0;
}

double medianSpacing(const PointCloud& cloud) {
  const PointAdaptor adaptor{cloud.points};
  const KdTree tree(3, adaptor, nanoflann::KDTreeSingleIndexAdaptorParams(kLeafPoints));
  const std::size_t step = std::max<std::size_t>(cloud.size() / kSampled, 1);
  std::vector<float> distances;
  for (std::size_t i = 0; i < cloud.size(); i += step) {
    const float distance = distanceToNext(tree, cloud.points[i]);
    if (distance > 0) distances.push_back(distance);
  }
  if (distances.empty()) return 0;
  const auto middle = distances.begin() + static_cast<std::ptrdiff_t>(distances.size() / 2);
  std::nth_element(distances.begin(), middle, distances.end());
  return static_cast<double>(*middle);
}

}  // namespace

CloudDescription describeCloud(const PointCloud& cloud) {
  if (cloud.empty()) throw UsageError("an empty cloud cannot be described");
  const Point3f& first = cloud.points.front();
  Eigen::Vector3f low(first.x, first.y, first.z), high = low;
  for (const Point3f& p : cloud.points) {
    const Eigen::Vector3f v(p.x, p.y, p.z);
    low = low.cwiseMin(v);
    high = high.cwiseMax(v);
  }
  return {cloud.origin + low.cast<double>(), cloud.origin + high.cast<double>(),
          medianSpacing(cloud)};
}

}  // namespace paloc

#include "paloc/map/scan_normals.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

#include "lanes4.h"
#include "plane_moments.h"

namespace paloc {
namespace {

constexpr float kFar = 1e15F;  // its square is a float still
constexpr int kMinNeighbours = 6;
// Thicker than any surface that a LiDAR of centimetres makes of a wall. planeOf() tells edges and
// bushes by thickness against width.
constexpr double kMaxThicknessM = 0.15;

constexpr std::size_t kProbes = 11;  // points that the density is measured at
constexpr double kFirstProbeM = 0.25, kLastProbeM = 4;

}  // namespace

ScanNormals::ScanNormals(std::span<const Point3f> points) : size_(points.size()) {
  const std::size_t padded = (points.size() + 3) / 4 * 4;
  for (std::vector<float>* axis : {&x_, &y_, &z_}) axis->assign(padded, kFar);
  for (std::size_t i = 0; i < points.size(); ++i) {
    x_[i] = points[i].x, y_[i] = points[i].y, z_[i] = points[i].z;
  }
}

std::size_t ScanNormals::countNear(std::size_t point, double radius_m) const {
  const auto radius_sq = static_cast<float>(radius_m * radius_m);
  int count = 0;
  for (std::size_t i = 0; i < x_.size(); i += 4) {
    const Float4 dx = load4(x_.data() + i) - x_[point], dy = load4(y_.data() + i) - y_[point],
                 dz = load4(z_.data() + i) - z_[point];
    count += std::popcount(bitsOf(dx * dx + dy * dy + dz * dz < radius_sq));
  }
  return static_cast<std::size_t>(count);
}

// On surfaces the number of neighbours grows with the square of the radius.
double ScanNormals::radiusFor(std::size_t neighbours) const {
  if (size_ == 0) return kFirstProbeM;
  double radius_m = kFirstProbeM;
  std::size_t median = 0;
  for (;; radius_m *= 2) {
    std::array<std::size_t, kProbes> counts{};
    for (std::size_t k = 0; k < kProbes; ++k) {
      counts[k] = countNear((2 * k + 1) * size_ / (2 * kProbes), radius_m);
    }
    std::nth_element(counts.begin(), counts.begin() + kProbes / 2, counts.end());
    median = counts[kProbes / 2];
    if (2 * median >= neighbours || 2 * radius_m > kLastProbeM) break;
  }
  const double ratio = static_cast<double>(neighbours) / static_cast<double>(median);
  return radius_m * std::sqrt(std::clamp(ratio, 0.01, 4.0));
}

Vec3 ScanNormals::at(const Point3f& point, double radius_m) const {
  const auto radius_sq = static_cast<float>(radius_m * radius_m);
  MomentSums sums;
  for (std::size_t i = 0; i < x_.size(); i += 4) {
    const Float4 dx = load4(x_.data() + i) - point.x, dy = load4(y_.data() + i) - point.y,
                 dz = load4(z_.data() + i) - point.z;
    unsigned near = bitsOf(dx * dx + dy * dy + dz * dz < radius_sq);
    for (; near != 0; near &= near - 1) {
      const int lane = std::countr_zero(near);
      sums.add(static_cast<double>(dx[lane]), static_cast<double>(dy[lane]),
               static_cast<double>(dz[lane]));
    }
  }
  if (sums.count < kMinNeighbours) return Vec3::Zero();
  const PlaneMoments moments(sums);
  const PlaneFitLimits limits{.max_thickness_m = kMaxThicknessM, .min_points = kMinNeighbours};
  return planeOf(moments, limits).planar() ? moments.normal : Vec3::Zero();
}

}  // namespace paloc

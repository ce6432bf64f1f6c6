#include "paloc/map/scan_normals.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

#include "lanes4.h"
#include "plane_moments.h"

namespace paloc {
namespace {

constexpr float kFar = 1e15F;     // its square is a float still
constexpr std::size_t kBox = 16;  // points
constexpr int kMinNeighbours = 6;
// Thicker than any surface that a LiDAR of centimetres makes of a wall. planeOf() tells edges and
// bushes by thickness against width.
constexpr double kMaxThicknessM = 0.15;

constexpr std::size_t kProbes = 11;  // points that the density is measured at
constexpr double kFirstProbeM = 0.25, kLastProbeM = 4;

}  // namespace

ScanNormals::ScanNormals(std::span<const Point3f> points) : size_(points.size()) {
  const std::size_t boxes = (points.size() + kBox - 1) / kBox, padded = (boxes + 3) / 4 * 4;
  for (std::vector<float>* axis : {&x_, &y_, &z_}) axis->assign(boxes * kBox, kFar);
  for (int axis = 0; axis < 3; ++axis) {
    low_[axis].assign(padded, kFar);
    high_[axis].assign(padded, -kFar);
  }
  for (std::size_t i = 0; i < points.size(); ++i) {
    x_[i] = points[i].x, y_[i] = points[i].y, z_[i] = points[i].z;
    const float at[3] = {x_[i], y_[i], z_[i]};
    for (int axis = 0; axis < 3; ++axis) {
      float &low = low_[axis][i / kBox], &high = high_[axis][i / kBox];
      low = std::min(low, at[axis]), high = std::max(high, at[axis]);
    }
  }
}

// Calls visit(which, dx, dy, dz) for four points after four of which some are within the radius.
template <typename Visit>
void ScanNormals::visitNear(const Point3f& point, double radius_m, const Visit& visit) const {
  const auto radius_sq = static_cast<float>(radius_m * radius_m);
  const float at[3] = {point.x, point.y, point.z};
  for (std::size_t box = 0; box < low_[0].size(); box += 4) {
    Float4 apart_sq{};
    for (int axis = 0; axis < 3; ++axis) {
      const Float4 below = load4(low_[axis].data() + box) - at[axis],
                   above = at[axis] - load4(high_[axis].data() + box);
      const Float4 apart = max4(max4(below, above), Float4{});
      apart_sq += apart * apart;
    }
    for (unsigned near = bitsOf(apart_sq < radius_sq); near != 0; near &= near - 1) {
      const std::size_t first = kBox * (box + static_cast<std::size_t>(std::countr_zero(near)));
      for (std::size_t i = first; i < first + kBox; i += 4) {
        const Float4 dx = load4(x_.data() + i) - point.x, dy = load4(y_.data() + i) - point.y,
                     dz = load4(z_.data() + i) - point.z;
        const Mask4 within = dx * dx + dy * dy + dz * dz < radius_sq;
        if (bitsOf(within) != 0) visit(within, dx, dy, dz);
      }
    }
  }
}

std::size_t ScanNormals::countNear(const Point3f& point, double radius_m) const {
  Mask4 count{};
  visitNear(point, radius_m, [&](const Mask4& within, const Float4&, const Float4&, const Float4&) {
    count -= within;  // a lane that holds is -1
  });
  const int sum = count[0] + count[1] + count[2] + count[3];
  return static_cast<std::size_t>(sum);
}

// On surfaces the number of neighbours grows with the square of the radius.
double ScanNormals::radiusFor(std::size_t neighbours) const {
  if (size_ == 0) return kFirstProbeM;
  double radius_m = kFirstProbeM;
  std::size_t median = 0;
  for (;; radius_m *= 2) {
    std::array<std::size_t, kProbes> counts{};
    for (std::size_t k = 0; k < kProbes; ++k) {
      const std::size_t probe = (2 * k + 1) * size_ / (2 * kProbes);
      counts[k] = countNear({x_[probe], y_[probe], z_[probe]}, radius_m);
    }
    std::nth_element(counts.begin(), counts.begin() + kProbes / 2, counts.end());
    median = counts[kProbes / 2];
    if (2 * median >= neighbours || 2 * radius_m > kLastProbeM) break;
  }
  const double ratio = static_cast<double>(neighbours) / static_cast<double>(median);
  return radius_m * std::sqrt(std::clamp(ratio, 0.01, 4.0));
}

Vec3 ScanNormals::at(const Point3f& point, double radius_m) const {
  MomentSums sums;
  visitNear(point, radius_m,
            [&](const Mask4& within, const Float4& dx, const Float4& dy, const Float4& dz) {
              for (unsigned near = bitsOf(within); near != 0; near &= near - 1) {
                const int lane = std::countr_zero(near);
                sums.add(static_cast<double>(dx[lane]), static_cast<double>(dy[lane]),
                         static_cast<double>(dz[lane]));
              }
            });
  if (sums.count < kMinNeighbours) return Vec3::Zero();
  const PlaneMoments moments(sums);
  const PlaneFitLimits limits{.max_thickness_m = kMaxThicknessM, .min_points = kMinNeighbours};
  return planeOf(moments, limits).planar() ? moments.normal : Vec3::Zero();
}

}  // namespace paloc

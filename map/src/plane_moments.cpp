#include "plane_moments.h"

#include <algorithm>
#include <cmath>

namespace paloc {
namespace {

constexpr double kMaxThicknessToWidth =
    0.65;                                   // above: a bush or a corner, with no normal to speak of
constexpr double kMinWidthToLength = 0.15;  // below: a line, whose normal is free to roll
constexpr double kMaxOwnOffset = 3.0;       // of the point itself, in thicknesses
constexpr float kNotPlanar = -1.0F;

constexpr int kMaxSteps = 24;
// Of the trace: the step after it is of the order of its cube.
constexpr double kStepEnough = 1e-4;

/// A symmetric matrix without negative eigenvalues.
struct Symmetric {
  double xx, xy, xz, yy, yz, zz;
};

// Of at least one point.
Symmetric covarianceOf(const MomentSums& sums) {
  const double inverse = 1.0 / sums.count;
  const Vec3 mean = inverse * Vec3(sums.first[0], sums.first[1], sums.first[2]);
  const auto central = [&](std::size_t at, Eigen::Index i, Eigen::Index k) {
    return sums.second[at] * inverse - mean[i] * mean[k];
  };
  return {central(0, 0, 0), central(1, 0, 1), central(2, 0, 2),
          central(3, 1, 1), central(4, 1, 2), central(5, 2, 2)};
}

// The eigenvalues, ascending. The characteristic polynomial p has real roots only: Halley's steps,
// 2 p p' / (2 p'^2 - p p''), come from zero to the smallest one from below, and never beyond. No
// more than the four operations and a square root, so that every machine gives the same bits.
Vec3 eigenvaluesOf(const Symmetric& a) {
  const double minor_x = a.yy * a.zz - a.yz * a.yz, minor_y = a.xx * a.zz - a.xz * a.xz,
               minor_z = a.xx * a.yy - a.xy * a.xy;
  const double c2 = a.xx + a.yy + a.zz, c1 = minor_x + minor_y + minor_z;
  const double c0 =
      a.xx * minor_x - a.xy * (a.xy * a.zz - a.yz * a.xz) + a.xz * (a.xy * a.yz - a.yy * a.xz);
  double least = 0;
  for (int i = 0; i < kMaxSteps; ++i) {
    const double value = ((least - c2) * least + c1) * least - c0;
    const double slope = (3 * least - 2 * c2) * least + c1;
    if (!(slope > 0) || !(value < 0)) break;
    const double half_bend = 3 * least - c2;
    const double step = value * slope / (slope * slope - value * half_bend);
    least -= step;
    if (-step < kStepEnough * c2) break;
  }
  const double sum = c2 - least, product = std::max(c1 - least * sum, 0.0);
  const double most = (sum + std::sqrt(std::max(sum * sum - 4 * product, 0.0))) / 2;
  const double middle = most > 0 ? std::max(product / most, least) : 0;
  return {least, middle, std::max(most, middle)};
}

// The unit eigenvector of a simple eigenvalue: it is across the rows of A - lambda I.
Vec3 eigenvectorOf(const Symmetric& a, double lambda) {
  const Vec3 x(a.xx - lambda, a.xy, a.xz), y(a.xy, a.yy - lambda, a.yz),
      z(a.xz, a.yz, a.zz - lambda);
  Vec3 best = x.cross(y);
  double best_sq = best.squaredNorm();
  for (const Vec3& other : {Vec3(x.cross(z)), Vec3(y.cross(z))}) {
    const double other_sq = other.squaredNorm();
    if (other_sq > best_sq) best = other, best_sq = other_sq;
  }
  return best_sq > 0 ? Vec3(best / std::sqrt(best_sq)) : Vec3::UnitZ();
}

}  // namespace

PlaneMoments::PlaneMoments(const MomentSums& sums) {
  if (sums.count < 3) return;
  count = sums.count;
  const double inverse = 1.0 / count;
  centroid = inverse * Vec3(sums.first[0], sums.first[1], sums.first[2]);
  const Symmetric covariance = covarianceOf(sums);
  variances = eigenvaluesOf(covariance);
  normal = eigenvectorOf(covariance, variances[0]);
}

// By the pivots of what is left when that is taken off the diagonal.
bool thickerThan(double variance, const MomentSums& sums) {
  if (sums.count < 3) return false;
  const Symmetric c = covarianceOf(sums);
  const double xx = c.xx - variance;
  if (!(xx > 0)) return false;
  const double yy = (c.yy - variance) * xx - c.xy * c.xy;  // times xx
  if (!(yy > 0)) return false;
  const double yz = c.yz * xx - c.xy * c.xz;
  const double zz = (c.zz - variance) * xx - c.xz * c.xz;
  return zz * yy - yz * yz > 0;
}

MapPlane planeOf(const PlaneMoments& m, const PlaneFitLimits& limits) {
  MapPlane plane;
  plane.thickness_m = kNotPlanar;
  if (m.count < std::max(limits.min_points, 3)) return plane;
  const double thickness = std::sqrt(m.variances[0]);
  const double width = std::sqrt(m.variances[1]), length = std::sqrt(m.variances[2]);
  const double offset = m.normal.dot(m.centroid);
  if (!(width > 0) || thickness > limits.max_thickness_m ||
      thickness > kMaxThicknessToWidth * width || width < kMinWidthToLength * length ||
      std::abs(offset) > std::max(kMaxOwnOffset * thickness, limits.clean_thickness_m)) {
    return plane;
  }
  plane.nx = static_cast<float>(m.normal.x());
  plane.ny = static_cast<float>(m.normal.y());
  plane.nz = static_cast<float>(m.normal.z());
  plane.offset_m = static_cast<float>(offset);
  plane.thickness_m = static_cast<float>(thickness);
  // Of a regression line: sigma across / (sqrt(n) sigma along), along the narrower axis.
  plane.normal_sigma_rad = static_cast<float>(thickness / (std::sqrt(m.count) * width));
  plane.points = static_cast<std::uint32_t>(m.count);
  return plane;
}

}  // namespace paloc

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "paloc/map/map_plane.h"

namespace paloc {
namespace {

constexpr double kMaxThicknessToWidth =
    0.65;                                   // above: a bush or a corner, with no normal to speak of
constexpr double kMinWidthToLength = 0.15;  // below: a line, whose normal is free to roll
constexpr double kMaxOwnOffset = 3.0;       // of the point itself, in thicknesses
constexpr double kMinGapToSpread = 2.0;     // two faces: the gap against the spread of either side
constexpr float kNotPlanar = -1.0F;

struct Moments {
  Vec3 centroid = Vec3::Zero();
  Vec3 normal = Vec3::Zero();
  Vec3 variances = Vec3::Zero();  // ascending
  int count = 0;
};

Vec3 toVec(const Point3f& p) {
  return {static_cast<double>(p.x), static_cast<double>(p.y), static_cast<double>(p.z)};
}

// Moments of the points whose height over the plane (in `heights`, empty: all) lies in [low, high].
Moments moments(std::span<const Point3f> points, std::span<const float> heights, float low,
                float high) {
  double sx = 0, sy = 0, sz = 0, xx = 0, xy = 0, xz = 0, yy = 0, yz = 0, zz = 0;
  Moments m;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (!heights.empty() && (heights[i] < low || heights[i] > high)) continue;
    const Vec3 p = toVec(points[i]);
    sx += p.x(), sy += p.y(), sz += p.z();
    xx += p.x() * p.x(), xy += p.x() * p.y(), xz += p.x() * p.z();
    yy += p.y() * p.y(), yz += p.y() * p.z(), zz += p.z() * p.z();
    ++m.count;
  }
  if (m.count < 3) return m;
  const double inverse = 1.0 / m.count;
  m.centroid = Vec3(sx, sy, sz) * inverse;
  Mat3 covariance;
  covariance << xx, xy, xz, xy, yy, yz, xz, yz, zz;
  covariance = covariance * inverse - m.centroid * m.centroid.transpose();
  Eigen::SelfAdjointEigenSolver<Mat3> solver;
  solver.computeDirect(covariance);
  m.normal = solver.eigenvectors().col(0);
  m.variances = solver.eigenvalues().cwiseMax(0.0);
  return m;
}

void measureHeights(std::span<const Point3f> points, const Moments& m, std::span<float> heights) {
  for (std::size_t i = 0; i < points.size(); ++i) {
    heights[i] = static_cast<float>(m.normal.dot(toVec(points[i]) - m.centroid));
  }
}

struct Band {
  float low, high;
};

// The band of heights that belongs to the face of the point itself (height `own`): where the sorted
// heights show a gap much wider than either side is thick, the side of the point; then, what lies
// within three robust standard deviations of that side's median.
Band ownFace(std::span<const float> heights, float own, double clean_m) {
  thread_local std::vector<float> sorted;
  sorted.assign(heights.begin(), heights.end());
  std::sort(sorted.begin(), sorted.end());
  std::size_t begin = 0, end = sorted.size(), cut = 0;
  float gap = 0;
  for (std::size_t i = 1; i < sorted.size(); ++i) {
    if (sorted[i] - sorted[i - 1] > gap) gap = sorted[i] - sorted[i - 1], cut = i;
  }
  const float thickest =
      std::max(sorted[cut > 0 ? cut - 1 : 0] - sorted.front(), sorted.back() - sorted[cut]);
  if (static_cast<double>(gap) > 4 * clean_m &&
      static_cast<double>(gap) > kMinGapToSpread * static_cast<double>(thickest) / 2) {
    (own < sorted[cut] ? end : begin) = cut;
  }
  const std::size_t count = end - begin;
  const float median = sorted[begin + count / 2];
  // Half of the middle half: 0.6745 standard deviations of a normal distribution.
  const float half_quartiles = (sorted[begin + (3 * count) / 4] - sorted[begin + count / 4]) / 2;
  const float sigma = std::max(half_quartiles / 0.6745F, static_cast<float>(clean_m) / 2);
  return {std::max(sorted[begin], median - 3 * sigma),
          std::min(sorted[end - 1], median + 3 * sigma)};
}

}  // namespace

MapPlane fitPlane(std::span<const Point3f> relative, float radius_m, const PlaneFitLimits& limits,
                  std::span<float> scratch) {
  MapPlane plane;
  plane.thickness_m = kNotPlanar;
  plane.radius_m = radius_m;
  Moments m = moments(relative, {}, 0, 0);
  if (m.count < limits.min_points) return plane;
  if (std::sqrt(m.variances[0]) > limits.clean_thickness_m) {
    // Two faces as far apart as the neighbourhood is wide make the normal of all its points turn:
    // then the nearer half, which is mostly the point's own face, shows it better.
    const Moments nearer =
        moments(relative.first(std::max<std::size_t>(relative.size() / 2, 3)), {}, 0, 0);
    if (nearer.variances[0] * m.variances[1] < m.variances[0] * nearer.variances[1]) m = nearer;
    const std::span<float> heights = scratch.first(relative.size());
    measureHeights(relative, m, heights);
    const Band band =
        ownFace(heights, static_cast<float>(-m.normal.dot(m.centroid)), limits.clean_thickness_m);
    const Moments refined = moments(relative, heights, band.low, band.high);
    if (refined.count >= limits.min_points) m = refined;
  }
  const double thickness = std::sqrt(m.variances[0]);
  const double width = std::sqrt(m.variances[1]), length = std::sqrt(m.variances[2]);
  const double offset = m.normal.dot(m.centroid);
  if (thickness > limits.max_thickness_m || thickness > kMaxThicknessToWidth * width ||
      width < kMinWidthToLength * length ||
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

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <bit>
#include <cmath>
#include <vector>

#include "lanes4.h"
#include "paloc/map/map_plane.h"
#include "plane_moments.h"
#include "point_vector.h"

namespace paloc {
namespace {

constexpr double kMaxThicknessToWidth =
    0.65;                                   // above: a bush or a corner, with no normal to speak of
constexpr double kMinWidthToLength = 0.15;  // below: a line, whose normal is free to roll
constexpr double kMaxOwnOffset = 3.0;       // of the point itself, in thicknesses
constexpr double kMinGapToSpread = 2.0;     // two faces: the gap against the spread of either side
constexpr float kNotPlanar = -1.0F;
// A face among several: heights over it, in thicknesses of a clean surface; points that planes are
// tried through; sine of the angle between two of them; the share of the points that must lie on
// it; its square thickness at most, in that of a clean surface.
constexpr double kConsensusWithin = 3, kConsensusShare = 0.5, kConsensusClean = 2.25;
constexpr std::size_t kConsensusPoints = 8;
constexpr float kConsensusSine = 0.3F;

// Moments of the points whose height over the plane (in `heights`, empty: all) lies in [low, high].
PlaneMoments moments(std::span<const Point3f> points, std::span<const float> heights, float low,
                     float high) {
  MomentSums sums{};
  int count = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (!heights.empty() && (heights[i] < low || heights[i] > high)) continue;
    const Vec3 p = toVec(points[i]);
    sums[0] += p.x(), sums[1] += p.y(), sums[2] += p.z();
    sums[3] += p.x() * p.x(), sums[4] += p.x() * p.y(), sums[5] += p.x() * p.z();
    sums[6] += p.y() * p.y(), sums[7] += p.y() * p.z(), sums[8] += p.z() * p.z();
    ++count;
  }
  return count < 3 ? PlaneMoments() : PlaneMoments(sums, count);
}

void measureHeights(std::span<const Point3f> points, const PlaneMoments& m,
                    std::span<float> heights) {
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

PlaneMoments::PlaneMoments(const MomentSums& sums, int points) : count(points) {
  const double inverse = 1.0 / points;
  centroid = Vec3(sums[0], sums[1], sums[2]) * inverse;
  Mat3 covariance;
  covariance << sums[3], sums[4], sums[5], sums[4], sums[6], sums[7], sums[5], sums[7], sums[8];
  covariance = covariance * inverse - centroid * centroid.transpose();
  Eigen::SelfAdjointEigenSolver<Mat3> solver;
  solver.computeDirect(covariance);
  normal = solver.eigenvectors().col(0);
  variances = solver.eigenvalues().cwiseMax(0.0);
}

MapPlane planeOf(const PlaneMoments& m, const PlaneFitLimits& limits) {
  MapPlane plane;
  plane.thickness_m = kNotPlanar;
  if (m.count < std::max(limits.min_points, 3)) return plane;
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

namespace {

/// Counts the points that lie near to planes through the origin.
class NearPlane {
 public:
  explicit NearPlane(std::span<const Point3f> points) {
    const std::size_t whole = (points.size() + 3) / 4 * 4;
    x_.assign(whole, kFar), y_.assign(whole, kFar), z_.assign(whole, kFar);
    for (std::size_t i = 0; i < points.size(); ++i) {
      x_[i] = points[i].x, y_[i] = points[i].y, z_[i] = points[i].z;
    }
  }
  int count(const Eigen::Vector3f& normal, float within_m) const {
    int sum = 0;
    for (std::size_t at = 0; at < x_.size(); at += 4) {
      const Float4 height = load4(x_.data() + at) * normal.x() +
                            load4(y_.data() + at) * normal.y() + load4(z_.data() + at) * normal.z();
      sum += std::popcount(bitsOf(height * height < within_m * within_m));
    }
    return sum;
  }

 private:
  // On no plane but by chance.
  static constexpr float kFar = 1e10F;
  std::vector<float> x_, y_, z_;
};

// The plane through the origin and two of the nearer points that the most points lie on, if these
// are a good part of all: one face of an edge, a corner or a thin wall.
bool findConsensus(std::span<const Point3f> points, const PlaneFitLimits& limits,
                   Eigen::Vector3f& normal) {
  const auto within = static_cast<float>(kConsensusWithin * limits.clean_thickness_m);
  const NearPlane near(points);
  const std::size_t tried = std::min(points.size() / 2, kConsensusPoints);
  const int needed =
      std::max(limits.min_points + 3,
               static_cast<int>(kConsensusShare * static_cast<double>(points.size())));
  int most = 0;
  for (std::size_t i = 0; i < tried; ++i) {
    const Eigen::Vector3f a(points[i].x, points[i].y, points[i].z);
    for (std::size_t k = i + 1; k < tried; ++k) {
      const Eigen::Vector3f b(points[k].x, points[k].y, points[k].z);
      const Eigen::Vector3f cross = a.cross(b);
      const float cross_sq = cross.squaredNorm();
      if (cross_sq < kConsensusSine * kConsensusSine * a.squaredNorm() * b.squaredNorm() ||
          cross_sq == 0) {
        continue;
      }
      const Eigen::Vector3f candidate = cross / std::sqrt(cross_sq);
      const int count = near.count(candidate, within);
      if (count > most) most = count, normal = candidate;
    }
  }
  return most >= needed;
}

// Moments of the points near to that plane, twice, each time nearer to what was found.
PlaneMoments consensusMoments(std::span<const Point3f> points, const PlaneFitLimits& limits,
                              const Eigen::Vector3f& normal, std::span<float> heights) {
  PlaneMoments m;
  m.normal = normal.cast<double>();
  for (int pass = 0; pass < 2; ++pass) {
    measureHeights(points, m, heights);
    const auto within = static_cast<float>(kConsensusWithin * limits.clean_thickness_m);
    const PlaneMoments next = moments(points, heights, -within, within);
    if (next.count < limits.min_points) return {};
    m = next;
  }
  return m;
}

}  // namespace

MapPlane fitPlane(std::span<const Point3f> relative, const PlaneFitLimits& limits,
                  std::span<float> scratch) {
  PlaneMoments m = moments(relative, {}, 0, 0);
  if (m.count >= limits.min_points && std::sqrt(m.variances[0]) > limits.clean_thickness_m) {
    Eigen::Vector3f normal = Eigen::Vector3f::Zero();
    const std::span<float> heights = scratch.first(relative.size());
    if (findConsensus(relative, limits, normal)) {
      const PlaneMoments face = consensusMoments(relative, limits, normal, heights);
      const MapPlane plane = planeOf(face, limits);
      if (plane.planar() && face.variances[0] <= limits.clean_thickness_m *
                                                     limits.clean_thickness_m * kConsensusClean)
        return plane;
    }
    // Two faces as far apart as the neighbourhood is wide make the normal of all its points turn:
    // then the nearer half, which is mostly the point's own face, shows it better.
    const PlaneMoments nearer =
        moments(relative.first(std::max<std::size_t>(relative.size() / 2, 3)), {}, 0, 0);
    if (nearer.variances[0] * m.variances[1] < m.variances[0] * nearer.variances[1]) m = nearer;
    measureHeights(relative, m, heights);
    const Band band =
        ownFace(heights, static_cast<float>(-m.normal.dot(m.centroid)), limits.clean_thickness_m);
    const PlaneMoments refined = moments(relative, heights, band.low, band.high);
    if (refined.count >= limits.min_points) m = refined;
  }
  return planeOf(m, limits);
}

}  // namespace paloc

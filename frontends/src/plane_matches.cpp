#include "paloc/frontends/plane_matches.h"

#include <algorithm>
#include <cmath>

namespace paloc {
namespace {

constexpr double kMaxLeverFactor = 8;        // further from its points a plane is a guess
constexpr double kMinIncidenceCosine = 0.1;  // flatter rays say little
constexpr double kKernel = 3;                // of the Geman-McClure kernel, in standard deviations
constexpr double kMadToSigma = 1.4826;
constexpr double kLeastScale = 0.5;
constexpr double kNormalNoise = 0.01;  // rad, beyond what the fit tells: surfaces are uneven
constexpr double kMaxThickness = 1.5;  // of a plane, in the usual one
constexpr double kUsualPoints = 30;    // that the usual thickness counts for

}  // namespace

void PlaneMatches::associate(std::span<const PlacedPoint> points, const LocalVoxelMap& map,
                             double gate_m, double least_voxel_m) {
  rows_.clear();
  LocalPlane plane;
  for (std::uint32_t i = 0; i < points.size(); ++i) {
    const PlacedPoint& p = points[i];
    if (!map.find(p.point_odom, p.ray, plane, least_voxel_m)) continue;
    if (plane.leverFactor(p.point_odom) > kMaxLeverFactor) continue;
    const double residual = plane.height(p.point_odom);
    if (std::abs(residual) > gate_m) continue;
    const double across = plane.normal.dot(p.ray);
    if (across * across < kMinIncidenceCosine * kMinIncidenceCosine * p.ray.squaredNorm()) continue;
    rows_.push_back({{plane.normal, p.lever, p.age_s, p.sag_s2, residual},
                     plane.normal.dot(plane.centroid),
                     i,
                     plane.thickness_m,
                     plane.width_m,
                     static_cast<double>(plane.points)});
  }
  setDeviations();
}

void PlaneMatches::move(std::span<const PlacedPoint> points) {
  for (Row& row : rows_) {
    const PlacedPoint& p = points[row.index];
    const Vec3 normal = row.point.normal;
    row.point = {normal, p.lever, p.age_s, p.sag_s2, normal.dot(p.point_odom) - row.offset};
  }
}

// The thickness of a plane with few points is drawn to the usual one, lest those that are thin by
// chance count most. Much thicker than usual is no plane with more noise, but clutter.
void PlaneMatches::setDeviations() {
  if (rows_.empty()) return;
  scratch_.clear();
  for (const Row& row : rows_) scratch_.push_back(row.thickness);
  const auto third = scratch_.begin() + static_cast<std::ptrdiff_t>(scratch_.size() / 3);
  std::nth_element(scratch_.begin(), third, scratch_.end());
  const double usual = std::max(*third, noise_floor_m_);  // clutter is never thin
  std::erase_if(rows_, [&](const Row& row) { return row.thickness > kMaxThickness * usual; });
  for (Row& row : rows_) {
    const double share = row.plane_points / (row.plane_points + kUsualPoints);
    const double noise_sq = share * row.thickness * row.thickness + (1 - share) * usual * usual;
    row.normal_variance =
        noise_sq / (row.plane_points * row.width * row.width) + kNormalNoise * kNormalNoise;
    row.sigma = std::sqrt(noise_sq);
  }
}

double PlaneMatches::robustScale() {
  if (rows_.empty()) return 1;
  scratch_.clear();
  for (const Row& row : rows_) scratch_.push_back(std::abs(row.point.residual) / row.sigma);
  const auto middle = scratch_.begin() + static_cast<std::ptrdiff_t>(scratch_.size() / 2);
  std::nth_element(scratch_.begin(), middle, scratch_.end());
  return std::max(kLeastScale, kMadToSigma * *middle);
}

void PlaneMatches::weigh(double widening_m, double unsure_m) {
  const double scale = robustScale();
  for (Row& row : rows_) {
    const double variance = scale * scale * row.sigma * row.sigma;
    const double width_sq = kKernel * kKernel * (variance + widening_m * widening_m);
    const double root = 1 + row.point.residual * row.point.residual / width_sq;
    row.weight = 1 / (root * root * (variance + unsure_m * unsure_m));
  }
}

template <int N>
PointToPlaneSums<N> PlaneMatches::sums(double ageing) const {
  PointToPlaneSums<N> sums;
  for (const Row& row : rows_) sums.add(row.point, row.weight, ageing);
  return sums;
}

template <int N>
Eigen::Matrix<double, N, N> PlaneMatches::normalNoise(double ageing) const {
  PointToPlaneSums<N> noise;
  for (const Row& row : rows_) {
    noise.addNormalNoise(row.point, row.weight, row.normal_variance, ageing);
  }
  return noise.information;
}

Mat3 PlaneMatches::normals() const {
  Mat3 sum = Mat3::Zero();
  for (const Row& row : rows_) sum += row.point.normal * row.point.normal.transpose();
  return sum;
}

template PALOC_EXPORT PointToPlaneSums<9> PlaneMatches::sums<9>(double) const;
template PALOC_EXPORT PointToPlaneSums<18> PlaneMatches::sums<18>(double) const;
template PALOC_EXPORT Eigen::Matrix<double, 9, 9> PlaneMatches::normalNoise<9>(double) const;
template PALOC_EXPORT Eigen::Matrix<double, 18, 18> PlaneMatches::normalNoise<18>(double) const;

}  // namespace paloc

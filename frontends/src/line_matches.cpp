#include "paloc/frontends/line_matches.h"

#include <algorithm>
#include <cmath>

#include "paloc/frontends/lio_state.h"

namespace paloc {
namespace {

constexpr double kKernel = 3;                // of the Geman-McClure kernel, in standard deviations
constexpr double kRayleighMedianSq = 1.386;  // median of the square of a length, 2 ln 2
constexpr double kLeastScaleSq = 0.25;
constexpr double kDirectionNoise = 0.02;  // rad, beyond what the fit tells
constexpr double kMostLengths = 4;        // beyond the end of its points a line is a guess

}  // namespace

std::array<PointToPlane, 2> pointToLine(const PlacedPoint& point, const LocalLine& line) {
  const Eigen::Matrix<double, 3, 2> across = tangentBasis(line.direction);
  const Vec3 away = point.point_odom - line.centroid;
  std::array<PointToPlane, 2> residuals;
  for (int i = 0; i < 2; ++i) {
    const Vec3 normal = across.col(i);
    residuals[static_cast<std::size_t>(i)] = {normal, point.lever, point.age_s, point.sag_s2,
                                              normal.dot(away)};
  }
  return residuals;
}

void LineMatches::associate(std::span<const PlacedPoint> points, const LineVoxels& map,
                            double gate_m) {
  rows_.clear();
  LocalLine line;
  for (const PlacedPoint& p : points) {
    if (!map.find(p.point_odom, line)) continue;
    const double along = line.direction.dot(p.point_odom - line.centroid);
    if (std::abs(along) > kMostLengths * line.length_m) continue;
    Row row;
    row.residuals = pointToLine(p, line);
    if (row.squared() > gate_m * gate_m) continue;
    const double thickness = std::max(line.thickness_m, noise_floor_m_);
    row.variance = thickness * thickness;
    row.direction_variance = row.variance / (line.points * line.length_m * line.length_m) +
                             kDirectionNoise * kDirectionNoise;
    rows_.push_back(row);
  }
}

double LineMatches::robustVariance() {
  if (rows_.empty()) return 1;
  scratch_.clear();
  for (const Row& row : rows_) scratch_.push_back(row.squared() / row.variance);
  const auto middle = scratch_.begin() + static_cast<std::ptrdiff_t>(scratch_.size() / 2);
  std::nth_element(scratch_.begin(), middle, scratch_.end());
  return std::max(kLeastScaleSq, *middle / kRayleighMedianSq);
}

void LineMatches::weigh(double widening_m) {
  const double scale_sq = robustVariance();
  for (Row& row : rows_) {
    const double variance = scale_sq * row.variance;
    const double width_sq = kKernel * kKernel * (variance + widening_m * widening_m);
    const double root = 1 + row.squared() / width_sq;
    row.weight = 1 / (root * root * variance);
  }
}

void LineMatches::addTo(PointToPlaneSums<9>& sums, double ageing) const {
  for (const Row& row : rows_) {
    for (const PointToPlane& residual : row.residuals) sums.add(residual, row.weight, ageing);
  }
}

void LineMatches::addNoiseTo(Mat9& noise, double ageing) const {
  PointToPlaneSums<9> sums;
  for (const Row& row : rows_) {
    for (const PointToPlane& residual : row.residuals) {
      sums.addNormalNoise(residual, row.weight, row.direction_variance, ageing);
    }
  }
  noise += sums.information;
}

}  // namespace paloc

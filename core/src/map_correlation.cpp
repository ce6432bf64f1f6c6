#include "paloc/core/map_correlation.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "paloc/core/mrpt_pose.h"

namespace paloc {
namespace {

constexpr double kWalk_mps = 1;
// Steps shorter than this are noise, not way: at rest they would add up.
constexpr double kStep_m = 0.1;

// Way from the anchor to a position, which becomes the anchor if it is far enough.
double wayTo(const Vec3& position, Vec3& anchor) {
  const double step = (position - anchor).norm();
  if (step < kStep_m) return 0;
  anchor = position;
  return step;
}

// Of each node: itself and the nodes before it, by their correlation with it.
std::vector<double> sumsBefore(std::span<const Vec3> positions, const std::vector<bool>& counted,
                               double distance_m) {
  std::vector<double> sums(positions.size());
  Vec3 anchor = positions.empty() ? Vec3::Zero() : positions[0];
  double sum = 0;
  for (std::size_t k = 0; k < positions.size(); ++k) {
    sum *= std::exp(-wayTo(positions[k], anchor) / distance_m);
    if (counted[k]) sum += 1;
    sums[k] = sum;
  }
  return sums;
}

}  // namespace

double ScanCorrelation::add(const Vec3& position_map, double since_last_s) {
  if (before_ == 0) {
    before_ = std::max(1.0, distance_m_ / (kWalk_mps * std::max(since_last_s, 1e-3)));
    anchor_ = position_map;
  } else {
    before_ = 1 + before_ * std::exp(-wayTo(position_map, anchor_) / distance_m_);
  }
  return 2 * before_ - 1;
}

std::vector<double> scansSharingErrors(std::span<const Vec3> positions_map,
                                       const std::vector<bool>& has_map_factor, double distance_m) {
  std::vector<Vec3> reversed(positions_map.rbegin(), positions_map.rend());
  const std::vector<bool> counted_reversed(has_map_factor.rbegin(), has_map_factor.rend());
  const std::vector<double> before = sumsBefore(positions_map, has_map_factor, distance_m);
  const std::vector<double> after = sumsBefore(reversed, counted_reversed, distance_m);
  std::vector<double> scans(positions_map.size(), 1);
  for (std::size_t k = 0; k < scans.size(); ++k) {
    if (has_map_factor[k]) scans[k] = before[k] + after[scans.size() - 1 - k] - 1;
  }
  return scans;
}

MapFactor mapFactorOf(const MapMatch& match, double scans, double robust_width) {
  using Square = Eigen::Matrix<double, 6, 6>;
  const Mat6 information = match.informationAmong(scans);
  Square alone = match.informationAmong(1);
  const double ridge = 1e-12 * alone.diagonal().maxCoeff();
  alone += ridge * Square::Identity();
  const Square shared = information + ridge * Mat6::Identity();
  // The mean square of a whitened residual of a scan on its own, over that of a right one.
  const double share = Square(alone.ldlt().solve(shared)).trace() / 6;
  const RobustKernel kernel{RobustKernel::Kind::kHuber,
                            robust_width * std::sqrt(std::clamp(share, 0.0, 1.0))};
  return MapFactor(fromMrpt(match.T_map_body), information, kernel);
}

double scansForOne(const MapMatch& match, double scans) {
  using Square = Eigen::Matrix<double, 6, 6>;
  const Square own = match.information, spread = match.shared_spread;
  Square alone = own + spread, among = own + scans * spread;
  const double ridge = 1e-12 * alone.diagonal().maxCoeff();
  alone += ridge * Square::Identity();
  among += ridge * Square::Identity();
  return std::max(Square(alone.ldlt().solve(among)).trace() / 6, 1.0);
}

MapFactor mapFactorOfOneAmong(const MapMatch& match, double scans, double robust_width) {
  const double for_one = scansForOne(match, scans);
  // A whitened residual is by the root of it less than that of a scan on its own.
  const RobustKernel kernel{RobustKernel::Kind::kHuber, robust_width / std::sqrt(for_one)};
  return MapFactor(fromMrpt(match.T_map_body), Mat6(match.informationAmong(1) / for_one), kernel);
}

}  // namespace paloc

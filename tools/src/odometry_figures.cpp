#include "paloc/tools/odometry_figures.h"

#include <algorithm>

#include "paloc/tools/error_statistics.h"

namespace paloc {
namespace {

constexpr double kSegment_m = 10, kSegmentStep_m = 1;  // a segment begins every metre of the way
constexpr double kSecond_s = 1.0, kSecondTolerance_s = 0.06;

// E = (true motion)^-1 (motion), after Sturm et al., 2012.
Pose errorOf(const OdometryPair& from, const OdometryPair& to) {
  const Pose truth = from.T_map_body_true.inverse() * to.T_map_body_true;
  return truth.inverse() * (from.T_odom_body.inverse() * to.T_odom_body);
}

void addDrift(const std::vector<OdometryPair>& pairs, OdometryFigures& figures) {
  std::vector<double> way{0};
  for (std::size_t i = 1; i < pairs.size(); ++i) {
    way.push_back(
        way.back() +
        (pairs[i].T_map_body_true.position - pairs[i - 1].T_map_body_true.position).norm());
  }
  figures.length_m = way.back();
  const Pose T_map_odom = pairs.front().T_map_body_true * pairs.front().T_odom_body.inverse();
  for (const OdometryPair& pair : pairs) {
    const double error =
        (T_map_odom * pair.T_odom_body.position - pair.T_map_body_true.position).norm();
    figures.worst_m = std::max(figures.worst_m, error);
    figures.end_error_m = error;
  }
  std::vector<double> shares;
  double next = 0;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    if (way[i] < next) continue;
    next = way[i] + kSegmentStep_m;
    const auto end = std::lower_bound(way.begin(), way.end(), way[i] + kSegment_m);
    if (end == way.end()) break;
    const auto j = static_cast<std::size_t>(end - way.begin());
    shares.push_back(errorOf(pairs[i], pairs[j]).position.norm() / (*end - way[i]));
  }
  const ErrorStatistics statistics = errorStatistics(shares);
  figures.drift_10m = statistics.mean;
  figures.drift_10m_max = statistics.max;
}

}  // namespace

OdometryFigures odometryFigures(const std::vector<OdometryPair>& pairs) {
  OdometryFigures figures;
  figures.frames = pairs.size();
  if (pairs.empty()) return figures;
  addDrift(pairs, figures);
  NormalizedErrorSums normalized;
  std::vector<double> frame_m, frame_rad, second_m, second_rad;
  std::size_t second = 0;  // the pair a second later
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    while (second + 1 < pairs.size() &&
           secondsBetween(pairs[i].t_ns, pairs[second].t_ns) < kSecond_s - kSecondTolerance_s) {
      ++second;
    }
    const double apart_s = secondsBetween(pairs[i].t_ns, pairs[second].t_ns);
    if (std::abs(apart_s - kSecond_s) <= kSecondTolerance_s) {
      const Pose error = errorOf(pairs[i], pairs[second]);
      second_m.push_back(error.position.norm());
      second_rad.push_back(so3::log(error.rotation).norm());
    }
    if (i == 0) continue;
    if (!pairs[i].continues) {
      ++figures.breaks;
      continue;
    }
    const Pose error = errorOf(pairs[i - 1], pairs[i]);
    frame_m.push_back(error.position.norm());
    frame_rad.push_back(so3::log(error.rotation).norm());
    const Pose motion = pairs[i - 1].T_odom_body.inverse() * pairs[i].T_odom_body;
    const Pose truth = pairs[i - 1].T_map_body_true.inverse() * pairs[i].T_map_body_true;
    if (!normalized.add(motion, truth, pairs[i].motion_covariance)) ++figures.unusable;
  }
  figures.rpe_frame_m = errorStatistics(frame_m).rmse;
  figures.rpe_frame_rad = errorStatistics(frame_rad).rmse;
  figures.rpe_second_m = errorStatistics(second_m).rmse;
  figures.rpe_second_rad = errorStatistics(second_rad).rmse;
  figures.normalized = normalized.result();
  return figures;
}

}  // namespace paloc

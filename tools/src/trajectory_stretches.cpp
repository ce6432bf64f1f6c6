#include "paloc/tools/trajectory_stretches.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace paloc {
namespace {

double largestSigma(const Mat3& covariance) {
  const Eigen::SelfAdjointEigenSolver<Mat3> solver(covariance, Eigen::EigenvaluesOnly);
  const double variance = solver.eigenvalues()[2];
  return std::isnan(variance) ? variance : std::sqrt(std::max(0.0, variance));
}

}  // namespace

std::vector<FlagStretch> flagStretches(const std::vector<TrajectoryPoint>& trajectory) {
  std::vector<FlagStretch> stretches;
  for (std::size_t i = 0; i < trajectory.size(); ++i) {
    const TrajectoryPoint& point = trajectory[i];
    if (stretches.empty() || stretches.back().flag != point.flag) {
      stretches.push_back({point.flag, i, 0, point.t_ns, point.t_ns});
    }
    ++stretches.back().count;
    stretches.back().end_ns = point.t_ns;
  }
  return stretches;
}

double positionSigma(const TrajectoryPoint& point) { return positionSigmaOf(point.covariance); }

double positionSigmaOf(const Mat6& pose_covariance) {
  return largestSigma(pose_covariance.topLeftCorner<3, 3>());
}

double rotationSigma(const TrajectoryPoint& point) {
  return largestSigma(point.covariance.bottomRightCorner<3, 3>());
}

}  // namespace paloc

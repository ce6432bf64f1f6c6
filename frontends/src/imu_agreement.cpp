#include "paloc/frontends/imu_agreement.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

namespace paloc {
namespace {

// How fast the normalized innovation is averaged, and the IMU's noise follows it.
constexpr double kLearning = 0.05, kMostDisagreement = 100;
constexpr double kFollowing = 0.1, kMostChange = 10, kMostFactor = 300;
constexpr double kLeastGain = 1e-6;  // m, rad

}  // namespace

// The step of an update has the covariance that the update takes away: its squared norm in that, a
// degree of freedom, is the normalized innovation squared, and 1 if IMU and scans are as good as
// they are said to be (Y. Bar-Shalom et al., "Estimation with Applications to Tracking and
// Navigation", 2001, section 5.4.2).
double ImuAgreement::squared(const Vec6& step, const Mat6& gained) {
  Eigen::Matrix<double, 6, 6> covariance = gained;
  covariance.diagonal().array() += kLeastGain * kLeastGain;
  const Eigen::Matrix<double, 6, 1> d = step;
  return d.dot(covariance.ldlt().solve(d)) / 6;
}

void ImuAgreement::compare(const Vec6& step, const Mat6& gained) {
  const double norm = squared(step, gained);
  if (!std::isfinite(norm) || norm < 0) return;
  disagreement_ += kLearning * (std::min(norm, kMostDisagreement) - disagreement_);
  const double change = std::clamp(norm, 1 / kMostChange, kMostChange);
  imu_factor_ = std::clamp(imu_factor_ * std::pow(change, kFollowing), 1.0, kMostFactor);
}

}  // namespace paloc

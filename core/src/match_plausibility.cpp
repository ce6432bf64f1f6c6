#include "paloc/core/match_plausibility.h"

#include <Eigen/LU>
#include <algorithm>
#include <vector>

#include "paloc/core/mrpt_pose.h"

namespace paloc {
namespace {

constexpr std::size_t kUsual = 40;  // matches that tell what is usual
constexpr double kChiSquaredMedian = 5.348, kChiSquared95 = 12.592;  // six degrees of freedom
// As good as usual: so much of the usual overlap, at most so many times the usual residual. Where a
// map lacks the faces of walls that a room shows, scans agree on the faces behind, a wall's
// thickness off: seen with 0.78 of the usual overlap.
constexpr double kUsualOverlap = 0.9, kUsualResidual = 1.5;
// What neither covariance knows of: deskewing, stamps, the interpolation of the odometry.
constexpr double kFloorM = 0.005, kFloorRad = 0.002;

Mat6 floorCovariance() {
  Vec6 variances;
  variances << Vec3::Constant(kFloorM * kFloorM), Vec3::Constant(kFloorRad * kFloorRad);
  return variances.asDiagonal();
}

double mahalanobisSquare(const Vec6& difference, const Mat6& information, const Mat6& covariance) {
  using Square = Eigen::Matrix<double, 6, 6>;
  const Square sum = Square::Identity() + Square(covariance * information);
  return difference.dot(information * sum.partialPivLu().solve(difference));
}

}  // namespace

double innovationSquare(const MapMatch& match, const Pose& T_map_body_predicted,
                        const Mat6& covariance) {
  const Vec6 difference = boxminus(fromMrpt(match.T_map_body), T_map_body_predicted);
  return mahalanobisSquare(difference, match.informationAmong(1), covariance + floorCovariance());
}

bool MatchPlausibility::believes(const MapMatch& match, const Pose& T_map_body_predicted,
                                 const Mat6& covariance) {
  const bool as_usual = asGoodAsUsual(match), waiting = last_ && !as_usual;
  const Quality quality{
      innovationSquare(match, T_map_body_predicted, waiting ? covariance_before_ : covariance),
      match.overlap, match.residual_median_m};
  const double excess = std::max(1.0, usual(&Quality::innovation_square) / kChiSquaredMedian);
  const double limit_sq = settings_.max_innovation_sigmas * settings_.max_innovation_sigmas;
  // Too few to know what is usual: nothing to refuse by.
  if (believed_.size() < kUsual / 2 ||
      quality.innovation_square <= excess * (waiting ? kChiSquared95 : limit_sq)) {
    believe(quality);
    return true;
  }
  if (!last_) covariance_before_ = covariance;
  const Contradiction now{match, T_map_body_predicted};
  agreeing_ = as_usual && last_ && agree(*last_, now) ? agreeing_ + 1 : 1;
  last_ = now;
  last_->match.thinned.reset();
  return agreeing_ > settings_.believe_after_contradictions;
}

void MatchPlausibility::believe(const Quality& quality) {
  believed_.push_back(quality);
  if (believed_.size() > kUsual) believed_.pop_front();
  last_.reset();
  agreeing_ = 0;
}

// Median of the matches believed last; 0 without any.
double MatchPlausibility::usual(double Quality::*what) const {
  if (believed_.empty()) return 0;
  std::vector<double> sorted;
  for (const Quality& quality : believed_) sorted.push_back(quality.*what);
  const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2);
  std::nth_element(sorted.begin(), middle, sorted.end());
  return *middle;
}

bool MatchPlausibility::asGoodAsUsual(const MapMatch& match) const {
  return match.overlap >= kUsualOverlap * usual(&Quality::overlap) &&
         match.residual_median_m <= kUsualResidual * usual(&Quality::residual_median_m);
}

// The motion between two matches is that of the predictions. Shared errors are the same in both.
bool MatchPlausibility::agree(const Contradiction& before, const Contradiction& now) const {
  const Pose motion = before.predicted.inverse() * now.predicted;
  const Pose expected = fromMrpt(before.match.T_map_body) * motion;
  const Vec6 difference = boxminus(fromMrpt(now.match.T_map_body), expected);
  // Both matches are about as good: half of the information for their difference.
  const double limit = settings_.max_innovation_sigmas;
  return mahalanobisSquare(difference, 0.5 * now.match.information, floorCovariance()) <=
         limit * limit;
}

}  // namespace paloc

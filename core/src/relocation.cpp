#include "paloc/core/relocation.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>

#include "paloc/core/mrpt_pose.h"

namespace paloc {
namespace {

// Three standard deviations beyond which registration alone does not find back.
constexpr double kReachM = 1.0, kReachRad = 0.2;
// Those within which a search about the expected pose finds it: further, the whole map is searched.
constexpr double kSearchReachM = 3.0, kSearchReachRad = 0.8;
constexpr double kSigmas = 3;
constexpr int kMostDoublings = 5;  // of the time between two searches that fail
constexpr double kUprightRad = 0.1;

double reachOf(const Mat3& covariance) {
  if (!covariance.allFinite()) return std::numeric_limits<double>::infinity();
  const Eigen::SelfAdjointEigenSolver<Mat3> solver(covariance, Eigen::EigenvaluesOnly);
  return kSigmas * std::sqrt(std::max(0.0, solver.eigenvalues()[2]));
}

double positionReach(const Mat6& covariance) { return reachOf(covariance.topLeftCorner<3, 3>()); }

double rotationReach(const Mat6& covariance) {
  return reachOf(covariance.bottomRightCorner<3, 3>());
}

}  // namespace

bool Relocation::lost(const Mat6& covariance) {
  return positionReach(covariance) > kReachM || rotationReach(covariance) > kReachRad;
}

MapMatch Relocation::seek(MapMatcher& matcher, const Scan& scan, const ExpectedPose& expected) {
  if (found_) return verify(matcher, scan, expected.T_last_body);
  const double wait_s =
      std::ldexp(settings_.start_search_interval_s, std::min(failures_, kMostDoublings));
  if (searched_ns_ && secondsBetween(*searched_ns_, expected.t_ns) < wait_s) {
    MapMatch waiting;
    waiting.T_map_body = toMrpt(expected.T_map_body);
    waiting.refusal = MatchRefusal::kNotTried;
    return waiting;
  }
  searched_ns_ = expected.t_ns;
  MapMatch match = search(matcher, scan, expected);
  if (!match.accepted()) {
    ++failures_;
    match.T_map_body = toMrpt(expected.T_map_body);
    return match;
  }
  found_ = Found{fromMrpt(match.T_map_body)};
  match.refusal = MatchRefusal::kNotConfirmed;
  return match;
}

void Relocation::reset() {
  found_.reset();
  searched_ns_.reset();
  failures_ = 0;
}

MapMatch Relocation::search(MapMatcher& matcher, const Scan& scan, const ExpectedPose& expected) {
  StartGuess guess;
  const bool near = positionReach(expected.covariance) <= kSearchReachM &&
                    rotationReach(expected.covariance) <= kSearchReachRad;
  if (near) guess.T_map_body = toMrpt(expected.T_map_body);
  if (rotationReach(expected.covariance) <= kSigmas * kUprightRad) {
    guess.up_body =
        (-(expected.T_map_body.rotation.transpose() * expected.gravity_map)).normalized();
  }
  return matcher.locate(scan, guess);
}

// The scan must do as a start itself where the place that was found has moved on to.
MapMatch Relocation::verify(MapMatcher& matcher, const Scan& scan, const Pose& motion) {
  found_->T_map_body = found_->T_map_body * motion;
  found_->motion_since = found_->motion_since * motion;
  StartGuess guess = StartGuess::near(toMrpt(found_->T_map_body));
  guess.search_around = false;
  MapMatch match = matcher.locate(scan, guess);
  found_->scans.count(match.accepted());
  if (match.accepted()) found_->T_map_body = fromMrpt(match.T_map_body);
  if (found_->scans.refuted()) {
    found_.reset();
    ++failures_;
  } else if (match.accepted() &&
             (found_->scans.confirmations < settings_.start_confirmations ||
              found_->motion_since.position.norm() < settings_.start_confirm_motion_m)) {
    match.refusal = MatchRefusal::kNotConfirmed;
  }
  return match;
}

}  // namespace paloc

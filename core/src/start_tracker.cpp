#include "paloc/core/start_tracker.h"

#include "paloc/core/mrpt_pose.h"
#include "paloc/core/text.h"

namespace paloc {
namespace {

constexpr double kSamePosition = 0.1, kSameRotation = 0.03;  // m, rad: two registrations agree

}  // namespace

void StartTracker::follow(const Pose& T_odom_body, bool continues) {
  if (T_odom_body_last_ && continues) {
    motion_since_first_ = motion_since_first_ * (T_odom_body_last_->inverse() * T_odom_body);
  }
  T_odom_body_last_ = T_odom_body;
}

std::optional<StartGuess> StartTracker::guessAt(TimeNs t_ns,
                                                const std::optional<Vec3>& up_body) const {
  if (!first_ || attempts_ >= settings_.max_start_attempts) return std::nullopt;
  StartGuess guess = *first_;
  guess.up_body = up_body;
  guess.search_around =
      !searched_ns_ || secondsBetween(*searched_ns_, t_ns) >= settings_.start_search_interval_s;
  if (guess.T_map_body) {
    guess.T_map_body = toMrpt(fromMrpt(*guess.T_map_body) * motion_since_first_);
    return guess;
  }
  // Which way a position alone moves on cannot be told.
  const bool left =
      guess.position_map && motion_since_first_.position.norm() > settings_.start_position_holds_m;
  if (!guess.search_around || left) return std::nullopt;
  return guess;
}

void StartTracker::tried(TimeNs t_ns, const StartGuess& guess, const MapMatch& match) {
  ++attempts_;
  last_refusal_ = match.refusal;
  if (guess.search_around) searched_ns_ = t_ns;
  pending_ = match.accepted() && match.searched;
  motion_at_start_ = motion_since_first_;
  scans_ = {};
}

bool StartTracker::confirm(const MapMatch& match) {
  if (!pending_ || match.refusal == MatchRefusal::kNoScan) return true;
  scans_.count(match.accepted());
  if (scans_.refuted()) return false;
  // Scans from the same spot say the same again: some way must lie between.
  const Pose moved = motion_at_start_.inverse() * motion_since_first_;
  pending_ = !confirmedEnough() || moved.position.norm() < settings_.start_confirm_motion_m;
  return true;
}

void StartTracker::drop() {
  pending_ = false;
  last_refusal_ = MatchRefusal::kNotConfirmed;
}

std::string StartTracker::reason() const {
  if (!first_) {
    return "no initial pose was given (--init-pose, --init-tum, --init-position or --init auto)";
  }
  if (attempts_ == 0) return "no frame had a scan to locate in the map";
  const std::string where = attempts_ == 1
                                ? "at the only scan tried: "
                                : text("at each of ", attempts_, " scans tried, the last time: ");
  if (first_->T_map_body) {
    return text("the initial pose was refused ", where, toString(last_refusal_),
                " (one within about 3 m and 45 degrees is needed)");
  }
  return text("no place in the map ", first_->position_map ? "about the initial position " : "",
              "was believed ", where, toString(last_refusal_));
}

MapMatch borneOut(MapMatcher& matcher, const Scan& scan, const StartGuess& guess, MapMatch match) {
  const MapMatch own = matcher.locate(scan, guess);
  const Vec6 apart = boxminus(fromMrpt(own.T_map_body), fromMrpt(match.T_map_body));
  if (!own.accepted()) {
    match.refusal = own.refusal;
  } else if (apart.head<3>().norm() > kSamePosition || apart.tail<3>().norm() > kSameRotation) {
    match.refusal = MatchRefusal::kNotConfirmed;
  }
  return match;
}

}  // namespace paloc

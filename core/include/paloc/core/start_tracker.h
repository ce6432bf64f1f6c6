#pragma once

#include <optional>
#include <string>

#include "paloc/core/confirmation.h"
#include "paloc/core/estimator_settings.h"
#include "paloc/core/map_matcher.h"
#include "paloc/core/pose.h"
#include "paloc/core/time.h"

namespace paloc {

/// How a run comes to its first pose: what is known of it, carried on by the odometry from the
/// first frame; which scans are tried; and whether the scans that follow bear out what a search
/// found.
class PALOC_EXPORT StartTracker {
 public:
  explicit StartTracker(const EstimatorSettings& settings) : settings_(settings) {}

  /// What is known at the first frame. Without it nothing is ever tried.
  void setGuess(const StartGuess& guess) { first_ = guess; }

  /// A frame, in order of time, until the start is believed. `continues`: the motion since the
  /// frame before is a measurement.
  void follow(const Pose& T_odom_body, bool continues);

  /// What to try at a frame with a scan; nothing where it is not its turn: after so many attempts,
  /// and soon after a search that failed, since the next scan would tell the same. `up_body` may be
  /// unknown.
  std::optional<StartGuess> guessAt(TimeNs t_ns, const std::optional<Vec3>& up_body) const;

  /// What came of it.
  void tried(TimeNs t_ns, const StartGuess& guess, const MapMatch& match);

  /// Whether the last start has not been borne out yet.
  bool pending() const { return pending_; }
  /// Hears what a scan after a pending start says from where it is expected. False: the start is to
  /// be dropped.
  bool confirm(const MapMatch& match);
  /// A start that is still pending at the end: believed if enough scans bore it out, although none
  /// from elsewhere.
  bool confirmedEnough() const { return scans_.confirmations >= settings_.start_confirmations; }
  /// It is given up.
  void drop();

  /// Why no start was found, one sentence without its full stop.
  std::string reason() const;

 private:
  const EstimatorSettings settings_;
  std::optional<StartGuess> first_;
  std::optional<Pose> T_odom_body_last_;
  Pose motion_since_first_, motion_at_start_;
  std::optional<TimeNs> searched_ns_;
  int attempts_ = 0;
  Confirmation scans_;  // since the last start
  bool pending_ = false;
  MatchRefusal last_refusal_ = MatchRefusal::kNone;
};

/// What a match after a start by search is worth as its confirmation: it stays accepted only if the
/// scan would do as a start itself (`guess`: where it is expected), at the same place.
PALOC_EXPORT MapMatch borneOut(MapMatcher& matcher, const Scan& scan, const StartGuess& guess,
                               MapMatch match);

}  // namespace paloc

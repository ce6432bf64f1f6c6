#pragma once

#include <deque>
#include <optional>

#include "paloc/core/estimator_settings.h"
#include "paloc/core/export.h"
#include "paloc/core/map_matcher.h"
#include "paloc/core/pose.h"

namespace paloc {

/// The square of the distance between a match and a prediction, in units of their covariances
/// together (Mahalanobis), over the directions that the match knows; `covariance` is the
/// prediction's, tangent [position in map, rotation on the right]. With d = match (-) prediction,
/// I the match's information on its own and P the covariance: d^T I (1 + P I)^-1 d, which needs no
/// inverse of I.
PALOC_EXPORT double innovationSquare(const MapMatch& match, const Pose& T_map_body_predicted,
                                     const Mat6& covariance);

/// Whether matches can be true beside what IMU, odometry and earlier matches say. Where the map is
/// wrong (a part missing, walls moved) registration may settle on the wrong surfaces with small
/// residuals: nothing but the contradiction tells. Two things keep this from locking a right
/// match out. What counts as a contradiction is relative to what is usual in this recording, whose
/// covariances may be too small. And the prediction may be the one that is wrong: matches that
/// contradict it one after the other, agree among themselves, and are as good as matches usually
/// are (overlap, residuals) are believed. Others agree among themselves where the map is wrong,
/// too: once contradicted they have to wait until they are near the prediction, as sure as that was
/// before, or as good as usual.
class PALOC_EXPORT MatchPlausibility {
 public:
  explicit MatchPlausibility(const EstimatorSettings& settings) : settings_(settings) {}

  /// Judges an accepted match, in order of time.
  bool believes(const MapMatch& match, const Pose& T_map_body_predicted, const Mat6& covariance);

 private:
  struct Quality {
    double innovation_square = 0, overlap = 0, residual_median_m = 0;
  };
  struct Contradiction {
    MapMatch match;
    Pose predicted;
  };

  bool agree(const Contradiction& before, const Contradiction& now) const;
  double usual(double Quality::*what) const;
  bool asGoodAsUsual(const MapMatch& match) const;
  void believe(const Quality& quality);

  EstimatorSettings settings_;
  std::deque<Quality> believed_;           // the last ones
  std::optional<Contradiction> last_;      // the match before, if it was refused
  Mat6 covariance_before_ = Mat6::Zero();  // of the prediction when contradictions began
  int agreeing_ = 0;  // contradictions in a row that agree, the last one among them
};

}  // namespace paloc

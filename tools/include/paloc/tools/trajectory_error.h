#pragma once

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "paloc/tools/error_statistics.h"
#include "paloc/tools/trajectory_association.h"

namespace paloc {

/// Absolute trajectory error (ATE): how far each pose of the estimate is from the reference's.
struct AbsoluteError {
  ErrorStatistics translation_m;
  ErrorStatistics rotation_rad;  ///< angle of R_estimate^T R_reference
  TimeNs worst_ns = 0;           ///< the reference's stamp where the translation is furthest off
};

AbsoluteError absoluteError(const std::vector<MatchedPose>& matched);

/// What the length of a relative motion is counted in.
enum class DeltaUnit {
  kFrames,  ///< matched poses
  kMetres,  ///< of way, along the estimate
  kSeconds,
};

/// The name on the command line ("frames", "m", "s").
std::string toString(DeltaUnit unit);

struct RelativeErrorSettings {
  double delta = 1;  ///< in `unit`; a whole number of frames
  DeltaUnit unit = DeltaUnit::kFrames;
  /// A step between matched poses longer than this (s) is a gap. 0: defaultMaxGap().
  double max_gap_s = 0;
  bool across_gaps = false;  ///< pair over gaps, too, as evo does
};

/// Relative pose error (RPE) after Sturm et al., "A benchmark for the evaluation of RGB-D SLAM
/// systems" (2012): E = (Q_i^-1 Q_j)^-1 (P_i^-1 P_j), Q the reference, P the estimate.
struct RelativeError {
  ErrorStatistics translation_m;
  ErrorStatistics rotation_rad;
  std::size_t pairs_across_gaps = 0;  ///< whether they were left out or not
  double max_gap_s = 0;               ///< that was taken
};

RelativeError relativeError(const std::vector<MatchedPose>& matched,
                            const RelativeErrorSettings& settings);

/// Frames: 1.5 median steps, for a delta counted in poses is another one as soon as a pose is
/// missing. Metres and seconds: not less than 0.5 s, for a pose that is missing inside of a pair
/// does it no harm.
double defaultMaxGap(const std::vector<MatchedPose>& matched, DeltaUnit unit);

/// Consecutive pairs (i, j), each beginning where the last one ends, as evo forms them (all_pairs
/// false). Metres: j is the first pose after `delta` of way, and the first pair begins after the
/// first `delta`. Seconds (evo has none): j is the pose nearest in time to `delta` after i.
std::vector<std::pair<std::size_t, std::size_t>> consecutivePairs(
    const std::vector<MatchedPose>& matched, double delta, DeltaUnit unit);

}  // namespace paloc

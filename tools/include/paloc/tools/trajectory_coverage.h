#pragma once

#include <cstddef>
#include <vector>

#include "paloc/tools/trajectory_association.h"

namespace paloc {

/// A stretch of time in which the reference has poses and the estimate has none.
struct TrajectoryGap {
  TimeNs begin_ns = 0;
  TimeNs end_ns = 0;
  std::size_t reference_poses = 0;  ///< that the estimate misses in it

  double length_s() const { return secondsBetween(begin_ns, end_ns); }
};

/// How much of the reference the estimate covers. What the reference itself does not have is not
/// asked for.
struct Coverage {
  double time_share = 0;            ///< of the reference's time span, 0..1
  double pose_share = 0;            ///< of the reference's poses, 0..1
  double max_gap_s = 0;             ///< steps of the estimate up to this length count as covered
  std::vector<TrajectoryGap> gaps;  ///< in order of time, within the reference's span
};

/// Both in order of time and not empty. `max_gap_s` 0: 1.5 median steps of the estimate.
/// `tolerance_s`: a reference's pose this near to the end of a gap is covered.
Coverage coverageOf(const std::vector<StampedPose>& reference,
                    const std::vector<StampedPose>& estimate, double max_gap_s, double tolerance_s);

}  // namespace paloc

#pragma once

#include <cstddef>
#include <vector>

#include "paloc/frontends/tum_file.h"

namespace paloc {

/// A trajectory in strict order of time, and what had to be done for it.
struct OrderedTrajectory {
  std::vector<StampedPose> poses;
  std::size_t out_of_order = 0;  ///< poses that came after a later one; put in their place
  std::size_t duplicates = 0;    ///< poses whose stamp another had already; the first was kept
};

OrderedTrajectory inOrderOfTime(std::vector<StampedPose> poses);

/// One pose of the estimate and the one of the reference that belongs to it.
struct MatchedPose {
  TimeNs t_ns = 0;  ///< the reference's stamp
  Pose reference;
  Pose estimate;
};

/// The outcome of an association by time.
struct Association {
  std::vector<MatchedPose> matched;  ///< in order of time
  /// Poses of the shorter trajectory whose nearest partner lies within the tolerance, but belongs
  /// to another one that is nearer: left out, so that no pose counts twice.
  std::size_t rivals = 0;
  /// The smallest difference in time between the two (s), whether matched or not.
  double nearest_s = 0;
};

/// Pairs each pose of the trajectory with fewer poses with the nearest in time of the other, where
/// that is at most `tolerance_s` away. One to one. Both must be in order of time and not empty.
Association associateByTime(const std::vector<StampedPose>& reference,
                            const std::vector<StampedPose>& estimate, double tolerance_s);

/// The median step (s) between consecutive stamps; 0 for fewer than two.
double medianStep(const std::vector<TimeNs>& stamps);

}  // namespace paloc

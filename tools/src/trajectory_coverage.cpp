#include "paloc/tools/trajectory_coverage.h"

#include <algorithm>

namespace paloc {
namespace {

std::size_t posesBetween(const std::vector<StampedPose>& poses, TimeNs after_ns, TimeNs before_ns) {
  const auto earlier = [](const StampedPose& a, const StampedPose& b) { return a.t_ns < b.t_ns; };
  const auto begin =
      std::upper_bound(poses.begin(), poses.end(), StampedPose{after_ns, {}}, earlier);
  const auto end = std::lower_bound(begin, poses.end(), StampedPose{before_ns, {}}, earlier);
  return static_cast<std::size_t>(end - begin);
}

std::vector<TimeNs> stampsOf(const std::vector<StampedPose>& poses) {
  std::vector<TimeNs> stamps;
  for (const StampedPose& pose : poses) stamps.push_back(pose.t_ns);
  return stamps;
}

}  // namespace

Coverage coverageOf(const std::vector<StampedPose>& reference,
                    const std::vector<StampedPose>& estimate, double max_gap_s,
                    double tolerance_s) {
  std::vector<TimeNs> stamps = stampsOf(estimate);
  Coverage result;
  result.max_gap_s = max_gap_s > 0 ? max_gap_s : 1.5 * medianStep(stamps);
  const TimeNs begin_ns = reference.front().t_ns;
  const TimeNs end_ns = reference.back().t_ns;
  const TimeNs tolerance_ns = nsFromSeconds(tolerance_s);

  // A gap at either end is one between the estimate and a stamp just outside the reference.
  stamps.insert(stamps.begin(), std::min(begin_ns - tolerance_ns - 1, stamps.front()));
  stamps.push_back(std::max(end_ns + tolerance_ns + 1, stamps.back()));
  double uncovered_s = 0;
  std::size_t missed = 0;
  for (std::size_t i = 1; i < stamps.size(); ++i) {
    if (secondsBetween(stamps[i - 1], stamps[i]) <= result.max_gap_s) continue;
    TrajectoryGap gap{std::max(stamps[i - 1], begin_ns), std::min(stamps[i], end_ns), 0};
    gap.reference_poses =
        posesBetween(reference, stamps[i - 1] + tolerance_ns, stamps[i] - tolerance_ns);
    if (gap.reference_poses == 0) continue;
    uncovered_s += gap.length_s();
    missed += gap.reference_poses;
    result.gaps.push_back(gap);
  }
  const double span_s = secondsBetween(begin_ns, end_ns);
  result.pose_share = 1 - static_cast<double>(missed) / static_cast<double>(reference.size());
  result.time_share = span_s > 0 ? 1 - uncovered_s / span_s : result.pose_share;
  return result;
}

}  // namespace paloc

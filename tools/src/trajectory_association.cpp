#include "paloc/tools/trajectory_association.h"

#include <algorithm>
#include <cstdlib>
#include <limits>
#include <utility>

#include "paloc/tools/quantile.h"

namespace paloc {
namespace {

bool earlier(const StampedPose& a, const StampedPose& b) { return a.t_ns < b.t_ns; }

// The pose nearest in time to `t_ns`, the earlier of two at the same distance.
std::size_t nearestInTime(const std::vector<StampedPose>& poses, TimeNs t_ns) {
  const auto after = std::lower_bound(poses.begin(), poses.end(), StampedPose{t_ns, {}}, earlier);
  if (after == poses.begin()) return 0;
  const auto before = after - 1;
  const bool is_after = after != poses.end() && after->t_ns - t_ns < t_ns - before->t_ns;
  return static_cast<std::size_t>((is_after ? after : before) - poses.begin());
}

struct IndexPair {
  std::size_t of_short = 0;
  std::size_t of_long = 0;
};

// Stamps are in order, so rivals for the same partner follow each other.
void keepNearer(std::vector<IndexPair>& pairs, const IndexPair& next,
                const std::vector<StampedPose>& shorter, const std::vector<StampedPose>& longer) {
  const TimeNs partner_ns = longer[next.of_long].t_ns;
  IndexPair& last = pairs.back();
  if (std::abs(shorter[next.of_short].t_ns - partner_ns) <
      std::abs(shorter[last.of_short].t_ns - partner_ns)) {
    last = next;
  }
}

}  // namespace

OrderedTrajectory inOrderOfTime(std::vector<StampedPose> poses) {
  OrderedTrajectory result;
  TimeNs latest_ns = std::numeric_limits<TimeNs>::min();
  for (const StampedPose& pose : poses) {
    if (pose.t_ns < latest_ns) ++result.out_of_order;
    latest_ns = std::max(latest_ns, pose.t_ns);
  }
  std::stable_sort(poses.begin(), poses.end(), earlier);
  const auto same = [](const StampedPose& a, const StampedPose& b) { return a.t_ns == b.t_ns; };
  const auto end = std::unique(poses.begin(), poses.end(), same);
  result.duplicates = static_cast<std::size_t>(poses.end() - end);
  poses.erase(end, poses.end());
  result.poses = std::move(poses);
  return result;
}

Association associateByTime(const std::vector<StampedPose>& reference,
                            const std::vector<StampedPose>& estimate, double tolerance_s) {
  const bool reference_longer = reference.size() >= estimate.size();
  const auto& shorter = reference_longer ? estimate : reference;
  const auto& longer = reference_longer ? reference : estimate;
  const TimeNs tolerance_ns = nsFromSeconds(tolerance_s);

  Association result;
  TimeNs nearest_ns = std::numeric_limits<TimeNs>::max();
  std::vector<IndexPair> pairs;
  for (std::size_t i = 0; i < shorter.size(); ++i) {
    const IndexPair pair{i, nearestInTime(longer, shorter[i].t_ns)};
    const TimeNs distance_ns = std::abs(longer[pair.of_long].t_ns - shorter[i].t_ns);
    nearest_ns = std::min(nearest_ns, distance_ns);
    if (distance_ns > tolerance_ns) continue;
    if (!pairs.empty() && pairs.back().of_long == pair.of_long) {
      ++result.rivals;
      keepNearer(pairs, pair, shorter, longer);
    } else {
      pairs.push_back(pair);
    }
  }
  result.nearest_s = secondsBetween(0, nearest_ns);
  for (const IndexPair& pair : pairs) {
    const StampedPose& r = reference_longer ? longer[pair.of_long] : shorter[pair.of_short];
    const StampedPose& e = reference_longer ? shorter[pair.of_short] : longer[pair.of_long];
    result.matched.push_back({r.t_ns, r.pose, e.pose});
  }
  return result;
}

double medianStep(const std::vector<TimeNs>& stamps) {
  std::vector<double> steps_s;
  for (std::size_t i = 1; i < stamps.size(); ++i) {
    steps_s.push_back(secondsBetween(stamps[i - 1], stamps[i]));
  }
  return quantile(std::move(steps_s), 0.5);
}

}  // namespace paloc

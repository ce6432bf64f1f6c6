#include "paloc/tools/eval_covariance.h"

#include "paloc/core/errors.h"
#include "paloc/core/mrpt_pose.h"
#include "paloc/tools/trajectory_association.h"

namespace paloc {

std::vector<CovariantPose> covariantPoses(const std::vector<TrajectoryPoint>& trajectory) {
  std::vector<CovariantPose> poses;
  poses.reserve(trajectory.size());
  for (const TrajectoryPoint& point : trajectory) {
    poses.push_back(
        {{point.t_ns, fromMrpt(point.T_map_body)}, point.covariance, toString(point.flag)});
  }
  return poses;
}

EvalCovarianceResult evaluateCovariance(const std::vector<StampedPose>& reference,
                                        const std::vector<CovariantPose>& estimate,
                                        double max_dt_s) {
  EvalCovarianceResult result;
  result.reference_poses = reference.size();
  result.estimate_poses = estimate.size();
  std::vector<StampedPose> poses;
  std::map<TimeNs, const CovariantPose*> rows;
  for (const CovariantPose& row : estimate) {
    poses.push_back(row.pose);
    rows.try_emplace(row.pose.t_ns, &row);  // of two with one stamp the first counts
  }
  const OrderedTrajectory truth = inOrderOfTime(reference), ordered = inOrderOfTime(poses);
  const Association association = associateByTime(ordered.poses, truth.poses, max_dt_s);
  if (association.matched.empty()) {
    throw IoError("no pose of the estimate lies within " + std::to_string(max_dt_s) +
                  " s of one of the reference");
  }
  NormalizedErrorSums all;
  std::map<std::string, NormalizedErrorSums> by_flag;
  for (const MatchedPose& match : association.matched) {
    const CovariantPose& row = *rows.at(match.t_ns);
    // Matched the other way round: the estimate's stamps are the ones that are kept.
    if (all.add(match.reference, match.estimate, row.covariance)) {
      by_flag[row.flag].add(match.reference, match.estimate, row.covariance);
    } else {
      ++result.unusable;
    }
  }
  result.all = all.result();
  for (const auto& [flag, errors] : by_flag) result.by_flag.emplace(flag, errors.result());
  return result;
}

}  // namespace paloc

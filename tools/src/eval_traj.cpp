#include "paloc/tools/eval_traj.h"

#include <cstdio>

#include "paloc/core/errors.h"

namespace paloc {
namespace {

std::string counted(std::size_t n, const std::string& one, const std::string& many) {
  return std::to_string(n) + ' ' + (n == 1 ? one : many);
}

std::string secondsText(double seconds) {
  char text[64];
  std::snprintf(text, sizeof text, "%.6g s", seconds);
  return text;
}

OrderedTrajectory readOrdered(const std::filesystem::path& file, std::vector<std::string>& notes) {
  OrderedTrajectory trajectory = inOrderOfTime(readTum(file));
  if (trajectory.out_of_order > 0) {
    notes.push_back(file.string() + ": " +
                    counted(trajectory.out_of_order, "pose is", "poses are") +
                    " out of order of time; put in their place");
  }
  if (trajectory.duplicates > 0) {
    notes.push_back(file.string() + ": " +
                    counted(trajectory.duplicates, "pose repeats", "poses repeat") +
                    " the stamp of another; the first in the file was kept");
  }
  return trajectory;
}

double durationOf(const std::vector<StampedPose>& poses) {
  return secondsBetween(poses.front().t_ns, poses.back().t_ns);
}

[[noreturn]] void failUnmatched(const EvalTrajSettings& settings, double nearest_s) {
  throw IoError("no pose of " + settings.estimate_file.string() + " lies within " +
                secondsText(settings.max_dt_s) + " of one of " + settings.reference_file.string() +
                ": the nearest two are " + secondsText(nearest_s) +
                " apart (--max-dt sets how far they may be)");
}

Association associate(const EvalTrajSettings& settings, const OrderedTrajectory& reference,
                      const OrderedTrajectory& estimate, std::vector<std::string>& notes) {
  Association association = associateByTime(reference.poses, estimate.poses, settings.max_dt_s);
  if (association.matched.empty()) failUnmatched(settings, association.nearest_s);
  if (association.rivals > 0) {
    notes.push_back(
        counted(association.rivals, "pose was", "poses were") +
        " left out of the association: the partner nearest in time belongs to a nearer pose");
  }
  return association;
}

void noteRelative(const EvalTrajResult& result, std::vector<std::string>& notes) {
  const RelativeError& relative = result.relative;
  const bool left_out = !result.settings.relative.across_gaps;
  if (relative.pairs_across_gaps > 0) {
    notes.push_back(
        counted(relative.pairs_across_gaps, "pair of the RPE spans", "pairs of the RPE span") +
        " a gap (a step of more than " + secondsText(relative.max_gap_s) +
        " between matched poses) and " + (relative.pairs_across_gaps == 1 ? "is " : "are ") +
        (left_out ? "left out; --across-gaps pairs them, as evo does"
                  : "kept, as --across-gaps asks"));
  }
  if (relative.translation_m.count == 0) {
    notes.push_back(
        "no pair of poses is left for the RPE: the delta is longer than the matched "
        "trajectory between its gaps");
  }
}

double wayOf(const std::vector<MatchedPose>& matched) {
  double length_m = 0;
  for (std::size_t i = 1; i < matched.size(); ++i) {
    length_m += (matched[i].reference.position - matched[i - 1].reference.position).norm();
  }
  return length_m;
}

}  // namespace

EvalTrajResult evaluateTrajectories(const EvalTrajSettings& settings) {
  EvalTrajResult result;
  result.settings = settings;
  const auto reference = readOrdered(settings.reference_file, result.notes);
  const auto estimate = readOrdered(settings.estimate_file, result.notes);
  result.reference_poses = reference.poses.size();
  result.estimate_poses = estimate.poses.size();
  result.reference_duration_s = durationOf(reference.poses);
  result.estimate_duration_s = durationOf(estimate.poses);

  const auto matched = associate(settings, reference, estimate, result.notes).matched;
  result.matched_poses = matched.size();
  result.matched_length_m = wayOf(matched);
  result.first_ns = matched.front().t_ns;
  result.coverage =
      coverageOf(reference.poses, estimate.poses, settings.relative.max_gap_s, settings.max_dt_s);

  result.T_reference_estimate = alignmentOf(matched, settings.alignment);
  const auto moved = aligned(matched, result.T_reference_estimate);
  result.absolute = absoluteError(moved);
  result.relative = relativeError(moved, settings.relative);
  noteRelative(result, result.notes);
  return result;
}

}  // namespace paloc

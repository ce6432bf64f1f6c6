#include "paloc/tools/report_summary.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "paloc/tools/html_text.h"

namespace paloc {
namespace {

double medianOf(std::vector<double> values) {
  if (values.empty()) return 0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

// A sigma that is not finite is the worst there is, not one to pass over.
double worstOf(const std::vector<double>& values) {
  double worst = 0;
  for (const double v : values) worst = std::isfinite(v) ? std::max(worst, v) : INFINITY;
  return worst;
}

void countTrajectory(const std::vector<TrajectoryPoint>& trajectory, ReportSummary& summary) {
  summary.poses = trajectory.size();
  if (trajectory.empty()) return;
  summary.duration_s = secondsBetween(trajectory.front().t_ns, trajectory.back().t_ns);
  std::vector<double> position, rotation;
  for (std::size_t i = 0; i < trajectory.size(); ++i) {
    const TrajectoryPoint& point = trajectory[i];
    ++summary.poses_by_flag[static_cast<std::size_t>(point.flag)];
    position.push_back(positionSigma(point));
    rotation.push_back(rotationSigma(point));
    if (i > 0) {
      summary.length_m +=
          (point.T_map_body.translation() - trajectory[i - 1].T_map_body.translation()).norm();
    }
  }
  summary.position_sigma_median_m = medianOf(position);
  summary.position_sigma_worst_m = worstOf(position);
  summary.rotation_sigma_median_rad = medianOf(rotation);
  summary.rotation_sigma_worst_rad = worstOf(rotation);
  summary.stretches = flagStretches(trajectory);
}

void countFrames(const std::vector<FrameDiagnostics>& diagnostics, ReportSummary& summary) {
  summary.frames = diagnostics.size();
  std::map<MatchRefusal, std::size_t> refusals;
  std::vector<double> residuals;
  for (const FrameDiagnostics& frame : diagnostics) {
    if (frame.match.accepted()) {
      ++summary.map_factors_used;
      residuals.push_back(frame.match.residual_rms_m);
    } else {
      ++refusals[frame.match.refusal];
    }
  }
  summary.residual_median_m = medianOf(residuals);
  for (const auto& [refusal, count] : refusals) {
    summary.refusals.emplace_back(toString(refusal), count);
  }
  std::stable_sort(summary.refusals.begin(), summary.refusals.end(),
                   [](const auto& a, const auto& b) { return a.second > b.second; });
}

std::string cameOut(const ReportSummary& s) {
  return counted(s.poses, "pose", "poses") + " over " + fixedNumber(s.duration_s, 1) + " s and " +
         shortNumber(s.length_m) + " m";
}

std::string sigmaText(const ReportSummary& s) {
  return "one standard deviation of position along its worst direction is " +
         lengthText(s.position_sigma_median_m) + " at the median and " +
         lengthText(s.position_sigma_worst_m) + " at worst";
}

// "12 are coasting (no map factor near), 3 are lost"
std::string doubts(const ReportSummary& s) {
  struct Doubt {
    PoseFlag flag;
    const char* meaning;
  };
  std::string text;
  for (const Doubt& doubt :
       {Doubt{PoseFlag::kDegenerate, "degenerate (the map leaves a direction weak or open)"},
        Doubt{PoseFlag::kCoasting, "coasting (no map factor near)"},
        Doubt{PoseFlag::kLost, "lost (not to be used)"}}) {
    const std::size_t n = s.count(doubt.flag);
    if (n == 0) continue;
    if (!text.empty()) text += ", ";
    text += countText(n) + (n == 1 ? " is " : " are ") + doubt.meaning;
  }
  return text;
}

std::string degradedHeadline(const ReportSummary& s) {
  if (s.count(PoseFlag::kLost) > 0) return "Part of the trajectory is lost";
  if (s.count(PoseFlag::kCoasting) > 0) return "Part of the trajectory is not held by the map";
  return "Part of the trajectory is held weakly by the map";
}

}  // namespace

ReportSummary summaryOf(const Result& result) {
  ReportSummary summary;
  countTrajectory(result.trajectory, summary);
  countFrames(result.diagnostics, summary);
  return summary;
}

Verdict verdictOf(const ReportData& data, const ReportSummary& s) {
  if (s.poses == 0) {
    const std::string& reason = data.result.no_trajectory_reason;
    return {VerdictLevel::kNone, "No trajectory",
            reason.empty() ? "No pose was found in the map." : reason};
  }
  const std::string interrupted =
      data.interrupted ? " The run was stopped before the recording's end." : "";
  if (s.count(PoseFlag::kGood) == s.poses) {
    return {data.interrupted ? VerdictLevel::kDegraded : VerdictLevel::kGood,
            data.interrupted ? "Stopped before the end" : "Held by the map throughout",
            "All " + cameOut(s) + " are fixed by the map in all six directions; " + sigmaText(s) +
                '.' + interrupted};
  }
  return {VerdictLevel::kDegraded, degradedHeadline(s),
          "Of " + cameOut(s) + ", " + shareText(s.count(PoseFlag::kGood), s.poses) +
              " are fixed by the map in all six directions; " + doubts(s) + "; " + sigmaText(s) +
              '.' + interrupted};
}

}  // namespace paloc

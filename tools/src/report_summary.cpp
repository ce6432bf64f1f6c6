#include "paloc/tools/report_summary.h"

#include <algorithm>
#include <cmath>
#include <map>

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

}  // namespace

ReportSummary summaryOf(const Result& result) {
  ReportSummary summary;
  countTrajectory(result.trajectory, summary);
  countFrames(result.diagnostics, summary);
  return summary;
}

}  // namespace paloc

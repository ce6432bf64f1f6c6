#include "paloc/tools/report_summary.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "paloc/tools/quantile.h"

namespace paloc {
namespace {

// A sigma that is not finite is the worst there is, not one to pass over.
double worstOf(const std::vector<double>& values) {
  double worst = 0;
  for (const double v : values) worst = std::isfinite(v) ? std::max(worst, v) : INFINITY;
  return worst;
}

// The map's tilt against gravity, from the last pose: all poses share one gravity.
void tellTilt(const TrajectoryPoint& last, ReportSummary& summary) {
  const Vec3 down = last.gravity_map.normalized();
  summary.map_tilt_rad = std::atan2(std::hypot(down.x(), down.y()), -down.z());
  summary.map_tilt_sigma_rad = std::hypot(last.gravity_sigma.x(), last.gravity_sigma.y());
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
  summary.position_sigma_median_m = quantile(position, 0.5);
  summary.position_sigma_worst_m = worstOf(position);
  summary.rotation_sigma_median_rad = quantile(rotation, 0.5);
  summary.rotation_sigma_worst_rad = worstOf(rotation);
  summary.stretches = flagStretches(trajectory);
  tellTilt(trajectory.back(), summary);
}

void countFrames(const std::vector<FrameDiagnostics>& diagnostics, ReportSummary& summary) {
  summary.frames = diagnostics.size();
  std::map<MatchRefusal, std::size_t> refusals;
  std::vector<double> residuals;
  for (const FrameDiagnostics& frame : diagnostics) {
    summary.frames_at_rest += frame.at_rest ? 1 : 0;
    if (frame.match.accepted()) {
      ++summary.map_factors_used;
      residuals.push_back(frame.match.residual_rms_m);
    } else {
      ++refusals[frame.match.refusal];
    }
  }
  summary.residual_median_m = quantile(residuals, 0.5);
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

#include <cstdio>
#include <nlohmann/json.hpp>
#include <numbers>

#include "paloc/core/text.h"
#include "paloc/tools/bench_frontends.h"
#include "paloc/tools/eval_covariance.h"

namespace paloc {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kDegree = std::numbers::pi / 180;

template <typename... Values>
void append(std::string& out, const char* format, Values... values) {
  char line[240];
  std::snprintf(line, sizeof line, format, values...);
  out += line;
}

void appendRun(std::string& out, const FrontendRun& run) {
  const OdometryFigures& f = run.figures;
  append(out,
         "%5zu %7zu %7.1f %8.3f %8.3f %9.2f %8.2f %8.2f %8.2f %8.3f %8.2f %8.3f %8.2f %8.1f%s\n",
         static_cast<std::size_t>(run.seed), f.frames, f.length_m, f.end_error_m, f.worst_m,
         100 * f.endDrift(), 100 * f.drift_10m, 100 * f.drift_10m_max, 1e3 * f.rpe_frame_m,
         f.rpe_frame_rad / kDegree, 1e3 * f.rpe_second_m, f.rpe_second_rad / kDegree,
         f.normalized.pose, 1e-6 * static_cast<double>(run.map_bytes),
         run.diverged() ? "  diverged" : "");
}

Json jsonOf(const FrontendRun& run) {
  const OdometryFigures& f = run.figures;
  return {
      {"seed", run.seed},
      {"frames", f.frames},
      {"breaks", f.breaks},
      {"without_truth", run.without_truth},
      {"length_m", f.length_m},
      {"end_error_m", f.end_error_m},
      {"worst_error_m", f.worst_m},
      {"drift_end", f.endDrift()},
      {"drift_10m_mean", f.drift_10m},
      {"drift_10m_max", f.drift_10m_max},
      {"rpe_frame",
       {{"translation_rmse_m", f.rpe_frame_m}, {"rotation_rmse_rad", f.rpe_frame_rad}}},
      {"rpe_1s", {{"translation_rmse_m", f.rpe_second_m}, {"rotation_rmse_rad", f.rpe_second_rad}}},
      {"motion", jsonOf(f.normalized)},
      {"unusable_covariances", f.unusable},
      {"map_bytes", run.map_bytes},
      {"diverged", run.diverged()},
      {"notes", run.notes}};
}

}  // namespace

std::string tableOf(const BenchFrontendsResult& result) {
  const BenchFrontendsSettings& s = result.settings;
  std::string out;
  if (s.log.empty()) {
    append(out, "%s: %s, %s, %g s\n\n", s.frontend.c_str(), s.scene.c_str(), s.sensor.c_str(),
           s.duration_s);
  } else {
    append(out, "%s: %s\n\n", s.frontend.c_str(), s.log.filename().c_str());
  }
  append(out, "%5s %7s %7s %8s %8s %9s %8s %8s %8s %8s %8s %8s %8s %8s\n", "", "", "way", "off at",
         "off at", "drift at", "drift", "in 10 m", "RPE, a", "frame", "RPE,", "1 s", "NEES", "map");
  append(out, "%5s %7s %7s %8s %8s %9s %8s %8s %8s %8s %8s %8s %8s %8s\n", "seed", "frames", "m",
         "end m", "most m", "end %", "mean %", "max %", "mm", "deg", "mm", "deg", "/dof", "MB");
  for (const FrontendRun& run : result.runs) appendRun(out, run);
  append(out, "\nNEES/dof of the motion from frame to frame, over all: %.2f\n", result.nees());
  if (!result.runs.empty()) {
    const NormalizedErrors& first = result.runs.front().figures.normalized;
    append(out,
           "of the first run: position %.2f (RMSE %.2f mm, sigma %.2f mm), rotation %.2f (%.4f "
           "deg, %.4f deg), %.1f %% outside of 99 %%\n",
           first.position, 1e3 * first.position_rmse_m, 1e3 * first.position_sigma_m,
           first.rotation, first.rotation_rmse_rad / kDegree, first.rotation_sigma_rad / kDegree,
           100 * first.outside_99);
  }
  append(out, "\n%-16s %8s %8s   processor time, ms\n", "stage", "p50", "p99");
  for (const StageTimes& stage : result.stages) {
    append(out, "%-16s %8.2f %8.2f\n", stage.name.c_str(), stage.percentile(0.5),
           stage.percentile(0.99));
  }
  for (const FrontendRun& run : result.runs) {
    for (const std::string& note : run.notes) out += text("note: ", note, "\n");
    if (result.runs.size() > 1) break;
  }
  return out;
}

Json jsonOf(const BenchFrontendsResult& result) {
  const BenchFrontendsSettings& s = result.settings;
  Json json;
  json["frontend"] = s.frontend;
  if (s.log.empty()) {
    json["scene"] = s.scene;
    json["sensor"] = s.sensor;
    json["duration_s"] = s.duration_s;
  } else {
    json["recording"] = s.log.string();
  }
  json["nees_per_dof"] = result.nees();
  json["runs"] = Json::array();
  for (const FrontendRun& run : result.runs) json["runs"].push_back(jsonOf(run));
  for (const StageTimes& stage : result.stages) {
    json["cpu_ms"][stage.name] = {{"p50", stage.percentile(0.5)}, {"p99", stage.percentile(0.99)}};
  }
  return json;
}

}  // namespace paloc

#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "paloc/tools/bench_corridor.h"

namespace paloc {
namespace {

using Json = nlohmann::ordered_json;

constexpr PoseFlag kFlags[] = {PoseFlag::kGood, PoseFlag::kDegenerate, PoseFlag::kCoasting,
                               PoseFlag::kLost};

template <typename... Values>
void append(std::string& out, const char* format, Values... values) {
  char line[200];
  std::snprintf(line, sizeof line, format, values...);
  out += line;
}

Json flagsJson(const std::array<std::size_t, 4>& counts) {
  Json json;
  for (const PoseFlag flag : kFlags) json[toString(flag)] = counts[static_cast<std::size_t>(flag)];
  return json;
}

Json jsonOf(const CorridorFigures& f) {
  return {{"along_at_end_m", f.along_at_end_m},
          {"along_max_m", f.along_max_m},
          {"across_rms_m", f.across_rms_m},
          {"across_max_m", f.across_max_m},
          {"exit_step_m", f.exit_step_m},
          {"along_max_sigmas", f.along_max_sigmas},
          {"nees_along", f.nees_along},
          {"nees_across", f.nees_across},
          {"poses", f.poses},
          {"flags_inside", flagsJson(f.inside)},
          {"flags_outside", flagsJson(f.outside)}};
}

Json jsonOf(const CorridorRun& run) {
  return {{"degeneracy_handling", run.degeneracy_handling},
          {"map_factors", run.map_factors},
          {"refused", run.refused},
          {"online", jsonOf(run.online)},
          {"batch", jsonOf(run.batch)}};
}

std::size_t of(const std::array<std::size_t, 4>& counts, PoseFlag flag) {
  return counts[static_cast<std::size_t>(flag)];
}

void appendPoses(std::string& out, const char* name, const FreeStretch& stretch,
                 const std::vector<CorridorPose>& poses) {
  const Vec3& axis = stretch.axis_map;
  const Vec3 left = Vec3::UnitZ().cross(axis);
  for (const CorridorPose& p : poses) {
    const Vec3 error = p.estimate.position - p.truth.position;
    const Mat3 covariance = p.covariance.topLeftCorner<3, 3>();
    append(out, "%s,%.4f,%.3f,%d", name, secondsBetween(poses.front().t_ns, p.t_ns),
           stretch.along(p.truth.position), stretch.holds(p.truth.position) ? 1 : 0);
    for (const Vec3& direction : {axis, left, Vec3(Vec3::UnitZ())}) {
      append(out, ",%.6f,%.6f", direction.dot(error),
             std::sqrt(direction.dot(covariance * direction)));
    }
    out += ',' + toString(p.flag) + '\n';
  }
}

void appendRow(std::string& out, const char* name, const CorridorFigures& f) {
  append(out, "%-22s %9.1f %9.1f %9.2f %9.2f %9.2f %8.2f %8.2f %8.2f\n", name,
         1e3 * f.along_at_end_m, 1e3 * f.along_max_m, 1e3 * f.across_rms_m, 1e3 * f.across_max_m,
         1e3 * f.exit_step_m, f.along_max_sigmas, f.nees_along, f.nees_across);
}

void appendFlags(std::string& out, const char* name, const CorridorRun& run) {
  const auto& inside = run.batch.inside;
  const auto& outside = run.batch.outside;
  append(out,
         "%-22s inside %zu good, %zu degenerate, %zu coasting, %zu lost; outside %zu, %zu, %zu, "
         "%zu; %zu scans refused\n",
         name, of(inside, PoseFlag::kGood), of(inside, PoseFlag::kDegenerate),
         of(inside, PoseFlag::kCoasting), of(inside, PoseFlag::kLost), of(outside, PoseFlag::kGood),
         of(outside, PoseFlag::kDegenerate), of(outside, PoseFlag::kCoasting),
         of(outside, PoseFlag::kLost), run.refused);
}

}  // namespace

std::vector<CorridorTarget> BenchCorridorResult::targets() const {
  const CorridorFigures &online = handled.online, &batch = handled.batch;
  const std::size_t unflagged = batch.poses - of(batch.inside, PoseFlag::kDegenerate);
  return {
      {"online: along at the end (m), 1.2 x drift", online.along_at_end_m, 1.2 * odometry_drift_m},
      {"batch: along, largest (m), drift / 4", batch.along_max_m, odometry_drift_m / 4},
      {"online: across, largest (m)", online.across_max_m, 0.01},
      {"batch: across, largest (m)", batch.across_max_m, 0.01},
      {"batch: step on leaving (m)", batch.exit_step_m, 0.02},
      {"online: along, largest (sigmas)", online.along_max_sigmas, 3},
      {"batch: along, largest (sigmas)", batch.along_max_sigmas, 3},
      {"batch: poses inside not flagged degenerate", static_cast<double>(unflagged), 0}};
}

std::string tableOf(const BenchCorridorResult& result) {
  std::string out;
  append(out, "corridor at %g degrees, %g m with a free axis, %s, %zu scans, seed %zu\n",
         result.settings.angle_deg, result.settings.free_m, result.settings.sensor.c_str(),
         result.scans, static_cast<std::size_t>(result.settings.seed));
  append(out, "odometry: scale %g, off by %.1f mm along the axis over it\n\n",
         result.settings.odometry_scale, 1e3 * result.odometry_drift_m);
  append(out, "%-22s %9s %9s %9s %9s %9s %8s %8s %8s\n", "", "along at", "along", "across",
         "across", "step on", "along", "NEES", "NEES/dof");
  append(out, "%-22s %9s %9s %9s %9s %9s %8s %8s %8s\n", "mm", "the end", "max", "rms", "max",
         "leaving", "sigmas", "along", "across");
  appendRow(out, "online", result.handled.online);
  appendRow(out, "batch", result.handled.batch);
  appendRow(out, "online, not handled", result.unhandled.online);
  appendRow(out, "batch, not handled", result.unhandled.batch);
  out += '\n';
  appendFlags(out, "flags", result.handled);
  appendFlags(out, "flags, not handled", result.unhandled);
  append(out, "\n%-46s %10s %10s\n", "target (with degeneracy handling)", "is", "at most");
  for (const CorridorTarget& t : result.targets()) {
    append(out, "%-46s %10.4g %10.4g  %s\n", t.name.c_str(), t.value, t.limit,
           t.met() ? "met" : "missed");
  }
  return out;
}

std::string posesCsv(const BenchCorridorResult& result) {
  std::string out =
      "trajectory,t_s,along_true_m,inside,along_m,along_sigma_m,left_m,left_sigma_m,up_m,"
      "up_sigma_m,flag\n";
  appendPoses(out, "online", result.stretch, result.handled.online_poses);
  appendPoses(out, "batch", result.stretch, result.handled.batch_poses);
  appendPoses(out, "online not handled", result.stretch, result.unhandled.online_poses);
  appendPoses(out, "batch not handled", result.stretch, result.unhandled.batch_poses);
  return out;
}

Json jsonOf(const BenchCorridorResult& result) {
  Json json;
  json["free_m"] = result.settings.free_m;
  json["angle_deg"] = result.settings.angle_deg;
  json["sensor"] = result.settings.sensor;
  json["seed"] = result.settings.seed;
  json["scans"] = result.scans;
  json["odometry_scale"] = result.settings.odometry_scale;
  json["odometry_drift_m"] = result.odometry_drift_m;
  json["handled"] = jsonOf(result.handled);
  json["unhandled"] = jsonOf(result.unhandled);
  json["targets"] = Json::array();
  for (const CorridorTarget& t : result.targets()) {
    json["targets"].push_back(
        {{"name", t.name}, {"value", t.value}, {"limit", t.limit}, {"met", t.met()}});
  }
  return json;
}

}  // namespace paloc

#include <algorithm>
#include <cstdarg>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <numbers>

#include "paloc/core/so3.h"
#include "paloc/tools/eval_traj.h"

namespace paloc {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kDegrees = 180 / std::numbers::pi;

[[gnu::format(printf, 1, 2)]] std::string formatted(const char* format, ...) {
  char text[512];
  va_list values;
  va_start(values, format);
  std::vsnprintf(text, sizeof text, format, values);
  va_end(values);
  return text;
}

Json orNull(const ErrorStatistics& s, double value) {
  return s.count > 0 ? Json(value) : Json(nullptr);
}

// The seven statistics, their names ending in the unit: "rotation_rmse_rad".
void put(Json& json, const std::string& prefix, const std::string& unit, const ErrorStatistics& s) {
  json[prefix + "rmse_" + unit] = orNull(s, s.rmse);
  json[prefix + "mean_" + unit] = orNull(s, s.mean);
  json[prefix + "median_" + unit] = orNull(s, s.median);
  json[prefix + "p95_" + unit] = orNull(s, s.p95);
  json[prefix + "std_" + unit] = orNull(s, s.std);
  json[prefix + "min_" + unit] = orNull(s, s.min);
  json[prefix + "max_" + unit] = orNull(s, s.max);
}

Json jsonOfPose(const Pose& pose) {
  const Quat q = Quat(pose.rotation).normalized();
  const double sign = q.w() < 0 ? -1 : 1;
  return {{"position_m", {pose.position.x(), pose.position.y(), pose.position.z()}},
          {"quaternion_xyzw", {sign * q.x(), sign * q.y(), sign * q.z(), sign * q.w()}}};
}

Json jsonOfCoverage(const EvalTrajResult& result) {
  const Coverage& coverage = result.coverage;
  Json gaps = Json::array();
  for (const TrajectoryGap& gap : coverage.gaps) {
    gaps.push_back({{"start_s", secondsBetween(result.first_ns, gap.begin_ns)},
                    {"length_s", gap.length_s()},
                    {"reference_poses", gap.reference_poses}});
  }
  return {{"time_share", coverage.time_share},
          {"pose_share", coverage.pose_share},
          {"max_gap_s", coverage.max_gap_s},
          {"gaps", gaps}};
}

std::string row(const std::string& name, const std::string& unit, double factor,
                const ErrorStatistics& s) {
  const auto head = formatted("%-18s %-4s", name.c_str(), unit.c_str());
  if (s.count == 0) return head + "        -  (no pair)\n";
  return head + formatted(" %8.4f %8.4f %8.4f %8.4f %8.4f %8.4f %8.4f %7zu\n", factor * s.rmse,
                          factor * s.mean, factor * s.median, factor * s.p95, factor * s.std,
                          factor * s.min, factor * s.max, s.count);
}

std::string coverageText(const EvalTrajResult& result) {
  const Coverage& coverage = result.coverage;
  std::string text = formatted("coverage   %.1f %% of the reference's time, %.1f %% of its poses",
                               100 * coverage.time_share, 100 * coverage.pose_share);
  if (coverage.gaps.empty()) return text + "; no gap\n";
  const auto longest = std::max_element(
      coverage.gaps.begin(), coverage.gaps.end(),
      [](const TrajectoryGap& a, const TrajectoryGap& b) { return a.length_s() < b.length_s(); });
  return text + formatted("; %zu gap%s, the longest %.2f s at %.2f s\n", coverage.gaps.size(),
                          coverage.gaps.size() == 1 ? "" : "s", longest->length_s(),
                          secondsBetween(result.first_ns, longest->begin_ns));
}

std::string alignmentText(const EvalTrajResult& result) {
  const std::string name = toString(result.settings.alignment);
  if (result.settings.alignment == Alignment::kNone) return "alignment  none\n";
  const Vec3& p = result.T_reference_estimate.position;
  const double angle = so3::log(result.T_reference_estimate.rotation).norm();
  return formatted("alignment  %s: moved by (%.3f, %.3f, %.3f) m, turned by %.3f deg\n",
                   name.c_str(), p.x(), p.y(), p.z(), kDegrees * angle);
}

}  // namespace

std::string tableOf(const EvalTrajResult& result) {
  const auto trajectory = [](const char* role, const std::filesystem::path& file, std::size_t poses,
                             double duration_s) {
    return formatted("%-10s %s: %zu poses, %.1f s\n", role, file.c_str(), poses, duration_s);
  };
  std::string text = trajectory("reference", result.settings.reference_file, result.reference_poses,
                                result.reference_duration_s);
  text += trajectory("estimate", result.settings.estimate_file, result.estimate_poses,
                     result.estimate_duration_s);
  text += formatted("matched    %zu poses within %g s, one to one, over %.1f m\n",
                    result.matched_poses, result.settings.max_dt_s, result.matched_length_m);
  text += coverageText(result) + alignmentText(result) + '\n';
  text += formatted("%-18s %-4s %8s %8s %8s %8s %8s %8s %8s %7s\n", "error", "", "rmse", "mean",
                    "median", "p95", "std", "min", "max", "count");
  text += row("ATE translation", "m", 1, result.absolute.translation_m);
  text += row("ATE rotation", "deg", kDegrees, result.absolute.rotation_rad);
  text += row("RPE translation", "m", 1, result.relative.translation_m);
  text += row("RPE rotation", "deg", kDegrees, result.relative.rotation_rad);
  text += formatted(
      "RPE: delta %g %s, consecutive pairs. ATE is worst at %.2f s after the first match.\n",
      result.settings.relative.delta, toString(result.settings.relative.unit).c_str(),
      secondsBetween(result.first_ns, result.absolute.worst_ns));
  for (const std::string& note : result.notes) text += "note: " + note + '\n';
  return text;
}

Json jsonOf(const EvalTrajResult& result) {
  Json json;
  json["align"] = toString(result.settings.alignment);
  json["T_reference_estimate"] = jsonOfPose(result.T_reference_estimate);
  json["poses"] = {{"reference", result.reference_poses},
                   {"estimate", result.estimate_poses},
                   {"matched", result.matched_poses}};
  json["max_dt_s"] = result.settings.max_dt_s;
  json["matched_length_m"] = result.matched_length_m;
  Json& ate = json["ate"];
  put(ate, "", "m", result.absolute.translation_m);
  put(ate, "rotation_", "rad", result.absolute.rotation_rad);
  ate["worst_at_s"] = secondsBetween(result.first_ns, result.absolute.worst_ns);
  Json& rpe = json["rpe"];
  rpe["delta"] = result.settings.relative.delta;
  rpe["unit"] = toString(result.settings.relative.unit);
  rpe["pairs"] = result.relative.translation_m.count;
  rpe["pairs_across_gaps"] = result.relative.pairs_across_gaps;
  rpe["across_gaps"] = result.settings.relative.across_gaps ? "kept" : "left out";
  rpe["max_gap_s"] = result.relative.max_gap_s;
  put(rpe, "translation_", "m", result.relative.translation_m);
  put(rpe, "rotation_", "rad", result.relative.rotation_rad);
  json["coverage"] = jsonOfCoverage(result);
  json["notes"] = result.notes;
  return json;
}

}  // namespace paloc

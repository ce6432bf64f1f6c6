#include "paloc/tools/replay_summary.h"

#include <cstdio>
#include <numbers>

#include "paloc/core/text.h"
#include "paloc/tools/finding_json.h"
#include "paloc/tools/peak_memory.h"
#include "paloc/tools/report_summary.h"
#include "paloc/tools/verdict.h"

namespace paloc {
namespace {

template <typename... Values>
std::string formatted(const char* format, Values... values) {
  char buffer[256];
  std::snprintf(buffer, sizeof buffer, format, values...);
  return buffer;
}

nlohmann::ordered_json flagsJson(const ReportSummary& summary) {
  nlohmann::ordered_json json = nlohmann::ordered_json::object();
  for (const PoseFlag flag :
       {PoseFlag::kGood, PoseFlag::kDegenerate, PoseFlag::kCoasting, PoseFlag::kLost}) {
    json[toString(flag)] = summary.count(flag);
  }
  return json;
}

nlohmann::ordered_json refusalsJson(const ReportSummary& summary) {
  nlohmann::ordered_json json = nlohmann::ordered_json::object();
  for (const auto& [reason, count] : summary.refusals) json[reason] = count;
  return json;
}

double degrees(double radians) { return radians * 180 / std::numbers::pi; }

double speedOf(const ReplayOutcome& outcome) {
  return outcome.wall_s > 0 ? outcome.recording_s / outcome.wall_s : 0;
}

nlohmann::ordered_json stagesJson(const std::vector<StageTimes>& stages) {
  nlohmann::ordered_json json = nlohmann::ordered_json::object();
  for (const StageTimes& s : stages) {
    json[s.name] = {{"calls", s.calls_ms.size()},
                    {"p50", s.percentile(0.5)},
                    {"p99", s.percentile(0.99)},
                    {"total", s.total_ms}};
  }
  return json;
}

std::string unusedText(const ReplayOutcome& outcome) {
  std::string out;
  for (const UnusedCounts::Row& row : outcome.unused.rows()) {
    out += "  " + std::to_string(row.count) + " x " + row.class_name + " '" + row.label +
           "': " + row.reason + '\n';
  }
  return out.empty() ? "not used         nothing\n" : "not used\n" + out;
}

std::string stagesText(const ReplayOutcome& outcome) {
  std::string out =
      formatted("%-16s %9s %9s %9s %9s\n", "stage", "calls", "p50 ms", "p99 ms", "total ms");
  for (const StageTimes& s : outcome.stages) {
    out += formatted("%-16s %9zu %9.3f %9.3f %9.1f\n", s.name.c_str(), s.calls_ms.size(),
                     s.percentile(0.5), s.percentile(0.99), s.total_ms);
  }
  return out;
}

}  // namespace

Verdict verdictOf(const ReplayOutcome& outcome) {
  return judge(outcome.result, summaryOf(outcome.result), outcome.end);
}

nlohmann::ordered_json summaryJson(const ReplayOutcome& outcome) {
  const Result& result = outcome.result;
  const ReportSummary summary = summaryOf(result);
  const Verdict verdict = judge(result, summary, outcome.end);
  nlohmann::ordered_json unused = nlohmann::ordered_json::array();
  for (const UnusedCounts::Row& row : outcome.unused.rows()) {
    unused.push_back({{"class", row.class_name},
                      {"label", row.label},
                      {"reason", row.reason},
                      {"count", row.count}});
  }
  nlohmann::ordered_json json = {
      {"status", verdict.status},
      {"sentence", verdict.sentence},
      {"poses", result.trajectory.size()},
      {"frames_before_start", result.frames_before_start},
      {"duration_s", summary.duration_s},
      {"length_m", summary.length_m},
      {"recording_s", outcome.recording_s},
      {"wall_s", outcome.wall_s},
      {"speed_x_realtime", speedOf(outcome)},
      {"peak_rss_mb", peakRssMb()},
      {"flags", flagsJson(summary)},
      {"frames_at_rest", summary.frames_at_rest},
      {"map_tilt_rad", {{"estimate", summary.map_tilt_rad}, {"sigma", summary.map_tilt_sigma_rad}}},
      {"map", {{"points", outcome.prior_map_points}, {"planar", outcome.prior_map_planar}}},
      {"map_factors", {{"used", summary.map_factors_used}, {"refused", refusalsJson(summary)}}},
      {"rematched",
       {{"tried", result.rematched.tried},
        {"gained", result.rematched.gained},
        {"withdrawn", result.rematched.withdrawn},
        {"not_kept", result.rematched.not_kept}}},
      {"unused", unused},
      {"notes", outcome.notes},
      {"findings", jsonOf(outcome.findings)},
      {"direction_changes", outcome.direction_changes},
      {"problems", outcome.end.problems},
      {"damage", outcome.end.damage},
      {"interrupted", outcome.end.interrupted},
      {"repairs",
       {{"damped", result.repairs.damped},
        {"factors_dropped", result.repairs.factors_dropped},
        {"reanchored", result.repairs.reanchored}}},
      {"stage_ms", stagesJson(outcome.stages)}};
  if (outcome.place) {
    json["octomap"] = octomapJson(*outcome.place);
    json["changes"] = changesJson(outcome.place->changes);
  }
  return json;
}

std::string summaryText(const ReplayOutcome& outcome) {
  const ReportSummary summary = summaryOf(outcome.result);
  const Verdict verdict = judge(outcome.result, summary, outcome.end);
  std::string out = verdict.status + ": " + verdict.sentence + '\n';
  out += formatted("poses            %zu over %.1f s and %.1f m\n", summary.poses,
                   summary.duration_s, summary.length_m);
  out += "map factors      " + std::to_string(summary.map_factors_used) + " used";
  for (const auto& [reason, count] : summary.refusals) {
    out += ", " + std::to_string(count) + " refused (" + reason + ")";
  }
  if (outcome.result.rematched.tried > 0) {
    const RematchCounts& anew = outcome.result.rematched;
    out += text("\nassociated anew  ", anew.tried, " times as smoothing moved their poses, ",
                anew.gained, " gained, ", anew.withdrawn, " withdrawn");
  }
  out += "\nat rest          " + std::to_string(summary.frames_at_rest) + " scans\n";
  if (summary.poses > 0) {
    out += formatted("tilt of the map  %.3f deg against gravity (1 sigma %.3f deg)\n",
                     degrees(summary.map_tilt_rad), degrees(summary.map_tilt_sigma_rad));
  }
  if (outcome.place) {
    out += "changes          " + changesSentence(outcome.place->changes) + '\n';
  }
  out += unusedText(outcome);
  out += formatted("repairs          %llu\n",
                   static_cast<unsigned long long>(outcome.result.repairs.total()));
  out += formatted("speed            %.1f x real time (%.1f s for %.1f s), %.0f MB at most\n",
                   speedOf(outcome), outcome.wall_s, outcome.recording_s, peakRssMb());
  return out + stagesText(outcome);
}

}  // namespace paloc

#include "paloc/tools/replay_summary.h"

#include <sys/resource.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>

#include "paloc/core/mrpt_pose.h"
#include "paloc/tools/trajectory_csv.h"

namespace paloc {
namespace {

template <typename... Values>
std::string formatted(const char* format, Values... values) {
  char buffer[256];
  std::snprintf(buffer, sizeof buffer, format, values...);
  return buffer;
}

std::map<std::string, std::uint64_t> countFlags(const Result& result) {
  std::map<std::string, std::uint64_t> counts;
  for (const PoseFlag flag :
       {PoseFlag::kGood, PoseFlag::kDegenerate, PoseFlag::kCoasting, PoseFlag::kLost}) {
    counts[toString(flag)] = 0;
  }
  for (const TrajectoryPoint& p : result.trajectory) ++counts[toString(p.flag)];
  return counts;
}

std::map<std::string, std::uint64_t> countRefusals(const Result& result) {
  std::map<std::string, std::uint64_t> counts;
  for (const FrameDiagnostics& d : result.diagnostics) {
    if (!d.match.accepted()) ++counts[toString(d.match.refusal)];
  }
  return counts;
}

std::uint64_t countUsed(const Result& result) {
  return static_cast<std::uint64_t>(
      std::count_if(result.diagnostics.begin(), result.diagnostics.end(),
                    [](const FrameDiagnostics& d) { return d.match.accepted(); }));
}

double durationOf(const std::vector<TrajectoryPoint>& trajectory) {
  return trajectory.empty() ? 0 : secondsBetween(trajectory.front().t_ns, trajectory.back().t_ns);
}

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

double lengthOf(const std::vector<TrajectoryPoint>& trajectory) {
  double length = 0;
  for (std::size_t k = 1; k < trajectory.size(); ++k) {
    length += (fromMrpt(trajectory[k].T_map_body).position -
               fromMrpt(trajectory[k - 1].T_map_body).position)
                  .norm();
  }
  return length;
}

double peakRssMb() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024;
}

ReplayVerdict judge(const ReplayOutcome& outcome) {
  const Result& result = outcome.result;
  if (result.trajectory.empty()) {
    return {"no localization", ExitCode::kNoLocalization,
            "no trajectory: " + result.no_trajectory_reason};
  }
  std::vector<std::string> blemishes;
  const auto flags = countFlags(result);
  const std::string all = std::to_string(result.trajectory.size());
  for (const char* flag : {"degenerate", "coasting", "lost"}) {
    if (flags.at(flag) > 0) {
      blemishes.push_back(std::to_string(flags.at(flag)) + " of " + all + " poses are flagged " +
                          flag);
    }
  }
  if (!outcome.damage.empty()) blemishes.push_back("the recording is damaged: " + outcome.damage);
  if (outcome.interrupted) blemishes.push_back("the replay was interrupted");
  if (result.batch_failed)
    blemishes.push_back("the batch smoothing failed, so the online result stands");
  if (result.repairs.total() > 0) {
    blemishes.push_back("the smoother made " + std::to_string(result.repairs.total()) + " repairs");
  }
  if (blemishes.empty()) {
    return {"good", ExitCode::kGood, "all " + all + " poses are fixed by the map"};
  }
  std::string sentence;
  for (const std::string& blemish : blemishes) sentence += (sentence.empty() ? "" : "; ") + blemish;
  return {"degraded", ExitCode::kDegraded, sentence};
}

nlohmann::ordered_json summaryJson(const ReplayOutcome& outcome) {
  const Result& result = outcome.result;
  const ReplayVerdict verdict = judge(outcome);
  nlohmann::ordered_json unused = nlohmann::ordered_json::array();
  for (const UnusedCounts::Row& row : outcome.unused.rows()) {
    unused.push_back({{"class", row.class_name},
                      {"label", row.label},
                      {"reason", row.reason},
                      {"count", row.count}});
  }
  return {{"status", verdict.status},
          {"sentence", verdict.sentence},
          {"poses", result.trajectory.size()},
          {"frames_before_start", result.frames_before_start},
          {"duration_s", durationOf(result.trajectory)},
          {"length_m", lengthOf(result.trajectory)},
          {"recording_s", outcome.recording_s},
          {"wall_s", outcome.wall_s},
          {"speed_x_realtime", speedOf(outcome)},
          {"peak_rss_mb", peakRssMb()},
          {"flags", countFlags(result)},
          {"map", {{"points", outcome.prior_map_points}, {"planar", outcome.prior_map_planar}}},
          {"map_factors", {{"used", countUsed(result)}, {"refused", countRefusals(result)}}},
          {"unused", unused},
          {"notes", outcome.notes},
          {"damage", outcome.damage},
          {"interrupted", outcome.interrupted},
          {"repairs",
           {{"damped", result.repairs.damped},
            {"factors_dropped", result.repairs.factors_dropped},
            {"reanchored", result.repairs.reanchored}}},
          {"stage_ms", stagesJson(outcome.stages)}};
}

std::string summaryText(const ReplayOutcome& outcome) {
  const Result& result = outcome.result;
  const ReplayVerdict verdict = judge(outcome);
  std::string out = verdict.status + ": " + verdict.sentence + '\n';
  for (const std::string& note : outcome.notes) out += "note: " + note + '\n';
  out += formatted("poses            %zu over %.1f s and %.1f m\n", result.trajectory.size(),
                   durationOf(result.trajectory), lengthOf(result.trajectory));
  out += "map factors      " + std::to_string(countUsed(result)) + " used";
  for (const auto& [reason, count] : countRefusals(result)) {
    out += ", " + std::to_string(count) + " refused (" + reason + ")";
  }
  out += '\n' + unusedText(outcome);
  out +=
      formatted("repairs          %llu\n", static_cast<unsigned long long>(result.repairs.total()));
  out += formatted("speed            %.1f x real time (%.1f s for %.1f s), %.0f MB at most\n",
                   speedOf(outcome), outcome.wall_s, outcome.recording_s, peakRssMb());
  return out + stagesText(outcome);
}

}  // namespace paloc

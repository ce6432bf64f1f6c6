#include "paloc/tools/replay_writers.h"

#include <cmath>

#include "paloc/map/cloud_io.h"
#include "paloc/tools/peak_memory.h"
#include "paloc/tools/replay_summary.h"
#include "paloc/tools/report_data.h"
#include "paloc/tools/trajectory_csv.h"

namespace paloc {
namespace {

ReportInput inputOf(const char* role, const std::filesystem::path& file, std::string detail) {
  ReportInput input;
  input.role = role;
  input.file = file.string();
  input.detail = std::move(detail);
  std::error_code error;
  const std::uintmax_t size = std::filesystem::file_size(file, error);
  if (!error) input.size_bytes = size;
  return input;
}

ReportData reportOf(const ReplayOptions& options, const Config& config,
                    const ReplayOutcome& outcome, const std::string& command_line) {
  ReportData data;
  data.name = options.log_file.stem().string();
  data.frontend = options.frontend;
  data.result = outcome.result;
  data.end = outcome.end;
  data.map_points = outcome.prior_map_sample;
  data.map_origin = outcome.prior_map_origin;
  data.unused = outcome.unused.rows();
  data.notes = outcome.notes;
  for (const StageTimes& s : outcome.stages) {
    data.stages.push_back(
        {s.name, s.calls_ms.size(), s.percentile(0.5), s.percentile(0.99), s.total_ms});
  }
  data.wall_time_s = outcome.wall_s;
  data.recording_time_s = outcome.recording_s;
  data.peak_rss_mb = peakRssMb();
  data.inputs.push_back(inputOf("recording", options.log_file, ""));
  data.inputs.push_back(inputOf("prior map", options.map_file,
                                std::to_string(outcome.prior_map_points) + " points used, " +
                                    std::to_string(outcome.prior_map_planar) + " with a plane"));
  data.settings_yaml = dumpConfig(config);
  data.command_line = command_line;
  data.versions = {{"paloc", PALOC_VERSION}};
  data.output_files = {
      {"trajectory.tum", "pose of the body in the map at the end of each scan"},
      {"trajectory_cov.csv", "the same with velocity, biases, covariance and flag"},
      {"diagnostics.csv", "a row per scan"},
      {"summary.json", "the figures of this report"},
      {"config_effective.yaml", "all settings"},
      {"map.ply", "the deskewed scans in the map's frame"}};
  if (outcome.place) {
    data.output_files.emplace_back("octomap.bt", "free and occupied space (OctoMap)");
    data.output_files.emplace_back("map_changes.ply", "what differs from the prior map");
    data.changes = changesSentence(outcome.place->changes);
  }
  return data;
}

}  // namespace

void writeResult(const ResultFolder& folder, const ReplayOptions& options, const Config& config,
                 const ReplayOutcome& outcome, const std::string& command_line) {
  const Result& result = outcome.result;
  if (!result.trajectory.empty()) {
    writeTum(folder.file("trajectory.tum"), stampedPoses(result.trajectory));
    writeTextFile(folder.file("trajectory_cov.csv"), trajectoryCsv(result.trajectory));
  }
  writeTextFile(folder.file("diagnostics.csv"), diagnosticsCsv(result.diagnostics));
  writeTextFile(folder.file("config_effective.yaml"), dumpConfig(config));
  writeTextFile(folder.file("summary.json"), summaryJson(outcome).dump(2) + '\n');
  writeReport(folder.file("report.html"), reportOf(options, config, outcome, command_line));
  if (!outcome.map_of_scans.empty()) {  // the largest comes last, should the disk become full
    savePly(folder.file("map.ply"), outcome.map_of_scans, "deskewed scans in the map's frame");
  }
  if (outcome.place) {
    outcome.place->occupancy->save(folder.file("octomap.bt"));
    saveChanges(folder.file("map_changes.ply"), outcome.place->changes);
  }
}

}  // namespace paloc

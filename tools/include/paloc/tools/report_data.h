#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "paloc/core/trajectory.h"
#include "paloc/core/types.h"
#include "paloc/core/unused_counts.h"
#include "paloc/tools/verdict.h"

namespace paloc {

/// A file that the run read.
struct ReportInput {
  std::string role;  ///< "recording", "prior map", "odometry", "initial pose", "configuration"
  std::string file;  ///< as the user gave it
  std::optional<std::uint64_t> size_bytes;
  std::string hash;    ///< with its kind ("fnv1a64:..."); empty if not computed
  std::string detail;  ///< one phrase ("929,000 points, 354 scans"); may be empty
};

/// Time spent in one stage, over the whole run.
struct ReportStage {
  std::string name;  ///< "map match"
  std::uint64_t calls = 0;
  double p50_ms = 0;
  double p99_ms = 0;
  double total_ms = 0;
};

/// What report.html is made of. Everything is plain data: the writer opens no other file and asks
/// no clock, so the same data give the same bytes.
struct ReportData {
  std::string name;      ///< of the run, for the title: the recording's, say
  std::string frontend;  ///< "recorded"
  std::string created;   ///< when, as text to show; may be empty
  Result result;
  RunEnd end;

  /// Points of the prior map, about 200,000 of them: the pictures' background. In the map frame
  /// (m), relative to `map_origin`, as in PointCloud.
  std::vector<Point3f> map_points;
  Vec3 map_origin = Vec3::Zero();

  std::vector<UnusedCounts::Row> unused;  ///< observations not used, and why
  std::vector<std::string> notes;         ///< sentences for the user
  std::string changes;  ///< what differs from the map, in one line; empty: was not looked for

  std::vector<ReportStage> stages;
  double wall_time_s = 0;       ///< of the whole run; 0 if not measured
  double recording_time_s = 0;  ///< that was replayed; 0: the trajectory's own time span
  double peak_rss_mb = 0;       ///< 0 if not measured

  std::vector<ReportInput> inputs;
  std::string settings_yaml;                                      ///< the effective configuration
  std::string command_line;                                       ///< that makes this result again
  std::vector<std::pair<std::string, std::string>> versions;      ///< ("paloc", "0.1.0"), ...
  std::vector<std::pair<std::string, std::string>> output_files;  ///< (name, what it holds)
};

/// Writes one self-contained HTML file: figures are inline SVG, no script, nothing from elsewhere.
/// An empty trajectory gives a report that says why. Throws IoError if it cannot be written
/// completely.
void writeReport(const std::filesystem::path& file, const ReportData& data);

}  // namespace paloc

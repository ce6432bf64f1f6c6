#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "paloc/tools/trajectory_alignment.h"
#include "paloc/tools/trajectory_coverage.h"
#include "paloc/tools/trajectory_error.h"

namespace paloc {

struct EvalTrajSettings {
  std::filesystem::path reference_file;
  std::filesystem::path estimate_file;
  Alignment alignment = Alignment::kNone;
  RelativeErrorSettings relative;
  double max_dt_s = 0.01;  ///< tolerance of the association
};

/// What comes out of the comparison of two trajectories.
struct EvalTrajResult {
  EvalTrajSettings settings;
  std::size_t reference_poses = 0;
  std::size_t estimate_poses = 0;
  std::size_t matched_poses = 0;
  double reference_duration_s = 0;
  double estimate_duration_s = 0;
  double matched_length_m = 0;  ///< of the reference's way over the matched poses
  TimeNs first_ns = 0;          ///< the reference's stamp of the first match
  Pose T_reference_estimate;    ///< the alignment
  AbsoluteError absolute;
  RelativeError relative;
  Coverage coverage;
  std::vector<std::string> notes;  ///< what the user must know: left out, put in order
};

/// Reads both files and compares them. Throws IoError if one cannot be read or no pose of the two
/// belongs together, UsageError if the settings do not fit the data.
EvalTrajResult evaluateTrajectories(const EvalTrajSettings& settings);

/// The result as a table for people.
std::string tableOf(const EvalTrajResult& result);

/// The result as JSON: m, rad, s. A statistic of nothing is null.
nlohmann::ordered_json jsonOf(const EvalTrajResult& result);

}  // namespace paloc

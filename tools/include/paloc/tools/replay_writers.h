#pragma once

#include <string>

#include "paloc/config/config.h"
#include "paloc/tools/replay.h"
#include "paloc/tools/result_folder.h"

namespace paloc {

/// Writes everything that a replay leaves in its folder: trajectory.tum, trajectory_cov.csv,
/// diagnostics.csv, summary.json, config_effective.yaml, map.ply and report.html. Files that need a
/// trajectory are left out when there is none. Throws IoError.
void writeResult(const ResultFolder& folder, const ReplayOptions& options, const Config& config,
                 const ReplayOutcome& outcome, const std::string& command_line);

}  // namespace paloc

#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "paloc/tools/command.h"
#include "paloc/tools/replay.h"

namespace paloc {

/// "good", "degraded" or "no localization", with the exit code that goes with it.
struct ReplayVerdict {
  std::string status;
  ExitCode code = ExitCode::kInternal;
  std::string sentence;  ///< for the user
};

/// Judges a finished replay: good only if every pose is, and the recording was read to its end.
ReplayVerdict judge(const ReplayOutcome& outcome);

/// summary.json, which `--json` prints as well.
nlohmann::ordered_json summaryJson(const ReplayOutcome& outcome);

/// The same for a reader: a table of what came out, what was not used, and where the time went.
std::string summaryText(const ReplayOutcome& outcome);

/// Length of the way (m).
double lengthOf(const std::vector<TrajectoryPoint>& trajectory);

/// Largest resident memory of this process so far (MB).
double peakRssMb();

}  // namespace paloc

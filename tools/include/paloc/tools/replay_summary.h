#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "paloc/tools/replay.h"

namespace paloc {

/// Judges a finished replay.
Verdict verdictOf(const ReplayOutcome& outcome);

/// summary.json, which `--json` prints as well.
nlohmann::ordered_json summaryJson(const ReplayOutcome& outcome);

/// The same for a reader: a table of what came out, what was not used, and where the time went. The
/// notes are left out: they were shown as they came up.
std::string summaryText(const ReplayOutcome& outcome);

}  // namespace paloc

#pragma once

#include <nlohmann/json.hpp>

#include "paloc/frontends/finding.h"

namespace paloc {

/// "note", "warning", "error"
const char* severityName(Severity severity);

/// An array; of each finding check, severity, label, value and unit (null and empty if there is
/// none), time (s since the epoch, or null) and sentence.
nlohmann::ordered_json jsonOf(const Findings& findings);

}  // namespace paloc

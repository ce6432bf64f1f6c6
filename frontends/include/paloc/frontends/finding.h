#pragma once

#include <optional>
#include <string>
#include <vector>

#include "paloc/core/time.h"

namespace paloc {

enum class Severity {
  kNote,     ///< worth knowing; nothing is wrong
  kWarning,  ///< costs accuracy, or part of the data
  kError,    ///< the result will be wrong
};

/// What a check of the data has found.
struct Finding {
  std::string check;  ///< which check ("clock-offset")
  Severity severity = Severity::kWarning;
  std::string label;            ///< of the sensor
  std::optional<double> value;  ///< the figure that it rests on, in `unit`
  std::string unit;             ///< "s", "m/s2", "" for counts and ratios
  std::optional<TimeNs> t_ns;   ///< where in the recording, if at one place
  std::string sentence;         ///< what is wrong, and the remedy
};

using Findings = std::vector<Finding>;

}  // namespace paloc

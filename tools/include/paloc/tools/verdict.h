#pragma once

#include <string>
#include <vector>

#include "paloc/tools/command.h"
#include "paloc/tools/report_summary.h"

namespace paloc {

/// What of a run its result alone does not tell.
struct RunEnd {
  bool interrupted = false;           ///< stopped by the user before the recording's end
  std::string damage;                 ///< how the recording ended early; empty if it did not
  std::vector<std::string> problems;  ///< what was asked for and could not be had, a sentence each
};

/// What came out and how far to trust it: the console, summary.json, the exit code and the report
/// all have it from here.
struct Verdict {
  ExitCode code = ExitCode::kInternal;
  std::string status;    ///< "good", "degraded", "no localization" or "unusable recording"
  std::string headline;  ///< a few words ("Held by the map throughout")
  std::string sentence;  ///< plain text, one sentence or a few
};

/// Good only if every pose is, the recording was read to its end, and nothing had to be repaired.
/// `summary` is that of `result`.
Verdict judge(const Result& result, const ReportSummary& summary, const RunEnd& end);

}  // namespace paloc

#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "paloc/frontends/finding.h"
#include "paloc/frontends/frontend_settings.h"
#include "paloc/frontends/motion_comparison.h"

namespace paloc {

/// What the checks of a recording came to.
struct RecordingCheck {
  std::string file;
  std::uint64_t observations = 0;
  Findings findings;  ///< without notes
  Findings notes;
  std::vector<MotionComparison> motions;
  std::string damage;   ///< one sentence; empty if the file is whole
  TimeNs first_ns = 0;  ///< of the recording: findings are told in seconds after it

  bool clean() const { return findings.empty() && damage.empty(); }
};

/// Reads a recording once, as a stream, with all checks. `progress` is told the share of the file's
/// bytes read. `map`: the prior map, whose scale is then checked, too; empty if there is none.
/// Throws IoError if a file cannot be opened or the recording holds nothing.
RecordingCheck checkRecording(const std::filesystem::path& file, const std::filesystem::path& map,
                              const FrontendSettings& settings,
                              const std::function<void(double share)>& progress);

std::string textOf(const RecordingCheck& check);
nlohmann::ordered_json jsonOf(const RecordingCheck& check);

}  // namespace paloc

#pragma once

#include <string>
#include <vector>

#include "paloc/frontends/calibration_block.h"

namespace paloc {

/// What a calibration came to, as sentences for the user: by how much T_body_lidar and the clocks
/// are off, with sigmas, and what to mend where that is sure. `T_body_lidar` is the recording's.
std::vector<std::string> reportOf(const CalibrationBlock& block, const Pose& T_body_lidar,
                                  const FastLioSettings& settings);

}  // namespace paloc

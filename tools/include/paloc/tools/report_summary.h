#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "paloc/core/trajectory.h"
#include "paloc/tools/trajectory_stretches.h"

namespace paloc {

/// The figures of a result that a verdict rests on.
struct ReportSummary {
  std::size_t poses = 0;
  std::array<std::size_t, 4> poses_by_flag{};  ///< indexed by PoseFlag
  double duration_s = 0;
  double length_m = 0;
  double position_sigma_median_m = 0;  ///< along the worst direction of each pose
  double position_sigma_worst_m = 0;
  double rotation_sigma_median_rad = 0;
  double rotation_sigma_worst_rad = 0;
  double residual_median_m = 0;  ///< median over the used map factors of the inliers' rms
  std::size_t frames = 0;
  std::size_t frames_at_rest = 0;
  double map_tilt_rad = 0;  ///< between gravity, as estimated, and the map's -z
  double map_tilt_sigma_rad = 0;
  std::size_t map_factors_used = 0;
  std::vector<std::pair<std::string, std::size_t>> refusals;  ///< reason and count, most first
  std::vector<FlagStretch> stretches;                         ///< of the whole trajectory

  std::size_t count(PoseFlag flag) const { return poses_by_flag[static_cast<std::size_t>(flag)]; }
};

ReportSummary summaryOf(const Result& result);

}  // namespace paloc

#pragma once

#include <cstdint>
#include <filesystem>

#include "paloc/core/time.h"
#include "paloc/tools/synth_motion.h"
#include "paloc/tools/synth_scene.h"

namespace paloc::synth {

constexpr double kCarryHeight_m = 1.35;  ///< of the body above the route

/// A walk with the sensor carried in front of the chest: round and round the scene's route, at 0.8
/// to 1.3 m/s, heading along the way with looks to the sides, bobbing and swaying at the gait's
/// pace. It begins and ends standing perfectly still (2.5 s, 2 s) and stands still (3 s) once a
/// minute, or midway if it is shorter. Deterministic in the seed.
Motion makeWalk(const std::vector<Vec3>& route, double duration_s, TimeNs start_ns,
                std::uint64_t seed);

/// A motion along given poses.
struct DrivenMotion {
  Motion motion;
  double deviation_rms_m = 0;  ///< of the motion from the given positions: what smoothing changed
  double deviation_max_m = 0;
  double longest_gap_s = 0;  ///< between two given poses; the motion goes straight in between
};

/// Reads a path of the body (TUM, scene frame) and smooths it with a Gaussian of `smoothing_s`, so
/// that accelerations make sense: a recorded path jitters by a centimetre from pose to pose.
/// Throws IoError for a file that cannot be read or whose stamps do not increase.
DrivenMotion motionFromFile(const std::filesystem::path& file, double smoothing_s);

}  // namespace paloc::synth

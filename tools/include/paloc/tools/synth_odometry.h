#pragma once

#include <cstdint>
#include <vector>

#include "paloc/frontends/tum_file.h"

namespace paloc::synth {

/// Errors of a simulated odometry, "another system's".
struct OdometryModel {
  /// Drift over the way: over 10 m straight on, the position is off by this share of the way, in
  /// equal parts by a scale error and by a yaw that drifts with the way; the signs are the seed's.
  double drift = 0.02;
  double scale = 1;                ///< every step is so many times too long, besides the drift
  double step_noise_m = 0.002;     ///< white, per step and axis (standard deviation)
  double step_noise_rad = 8.7e-4;  ///< 0.05 degrees
};

/// The odometry's poses T_odom_body for the true poses T_map_body; the first is the identity.
std::vector<StampedPose> simulateOdometry(const OdometryModel& model,
                                          const std::vector<StampedPose>& truth,
                                          std::uint64_t seed);

}  // namespace paloc::synth

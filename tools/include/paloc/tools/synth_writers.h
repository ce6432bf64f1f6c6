#pragma once

#include <filesystem>

#include "paloc/tools/synth_imu.h"
#include "paloc/tools/synth_timeline.h"

namespace paloc::synth {

/// Writes t_s, position, quaternion, velocity (map frame) and biases (body frame), a line per IMU
/// sample.
void writeImuTruth(const std::filesystem::path& file, const std::vector<ImuTruth>& imu);

/// Writes everything that tells what the recording is: settings, frames, files. Holds nothing that
/// differs from run to run.
void writeDescription(const std::filesystem::path& file, const SynthSettings& settings,
                      const Scene& scene, const SensorModel& sensor, const SynthSummary& summary);

}  // namespace paloc::synth

#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "paloc/tools/synth_change.h"
#include "paloc/tools/synth_fault.h"
#include "paloc/tools/synth_imu.h"
#include "paloc/tools/synth_odometry.h"
#include "paloc/tools/synth_survey.h"

namespace paloc::synth {

/// T_body_lidar unless told otherwise: the rig of the FusionPortable dataset, tilted a little so
/// that a wrong extrinsic cannot go unseen.
Pose defaultExtrinsic();

/// What is to be simulated.
struct SynthSettings {
  std::string scene = "building";
  std::filesystem::path map_file;  ///< an OctoMap to cast rays into, instead of a scene
  std::string sensor = "os1-128";
  std::filesystem::path trajectory;      ///< TUM; empty: a walk along the scene's route
  double trajectory_smoothing_s = 0.15;  ///< see motionFromFile
  double duration_s = 60;                ///< of the scans; a shorter trajectory ends sooner
  std::uint64_t seed = 1;
  std::optional<double> range_noise_m;  ///< instead of the sensor's own
  Pose T_body_lidar = defaultExtrinsic();
  ImuModel imu;
  OdometryModel odometry;
  SurveyModel survey;
  /// From, to: nothing was recorded (s, after the first scan's start), while the platform went on.
  std::optional<std::array<double, 2>> blackout_s;
  std::vector<Fault> faults;     ///< of the recording, in this order
  std::vector<Change> changes;   ///< between the survey and the recording, in this order
  std::filesystem::path folder;  ///< made if it does not exist
  bool gzip = false;
  bool overwrite = false;
  int threads = 0;  ///< 0: all processors. Changes nothing but the time
};

/// What was written.
struct SynthSummary {
  std::size_t scans = 0;
  std::size_t points = 0;  ///< returns in all scans
  std::size_t scans_without_returns = 0;
  std::size_t imu_samples = 0;
  std::size_t odometry_poses = 0;
  std::size_t map_points = 0;
  double duration_s = 0;            ///< from the first scan's start to the last one's end
  double length_m = 0;              ///< of the way between the first and the last pose
  double odometry_end_error_m = 0;  ///< after the first poses are laid on each other
  std::vector<std::string> notes;   ///< sentences for the user
  std::vector<std::filesystem::path> files;
};

/// Called from time to time with the share of the work done, 0..1, and the file being written.
using SynthProgress = std::function<void(double share, const std::string& file)>;

/// Simulates and writes recording.rawlog, truth.tum, truth_imu.csv, map.ply (of a scene: a map file
/// is its own) and synth.json, and where something was changed after the survey changes.json. Same
/// settings, same bytes. Throws UsageError for unknown names and where files would be overwritten,
/// IoError for what cannot be read or written.
SynthSummary writeRecording(const SynthSettings& settings, const SynthProgress& progress);

}  // namespace paloc::synth

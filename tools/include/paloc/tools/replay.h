#pragma once

#include <atomic>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "paloc/config/config.h"
#include "paloc/core/imu_buffer.h"
#include "paloc/core/start_guess.h"
#include "paloc/core/trajectory.h"
#include "paloc/core/unused_counts.h"
#include "paloc/frontends/finding.h"
#include "paloc/map/point_cloud.h"
#include "paloc/tools/place_changes.h"
#include "paloc/tools/stage_stopwatch.h"
#include "paloc/tools/verdict.h"

namespace paloc {

/// What a replay is asked to do.
struct ReplayOptions {
  std::filesystem::path log_file;
  std::filesystem::path map_file;
  std::string frontend = "recorded";
  std::optional<StartGuess> initial;  ///< what is known of the pose at the first scan
  double from_s = 0;                  ///< skip so much of the recording at its start
  std::optional<double> to_s;         ///< stop so long after the recording's start
  bool online = false;                ///< the result is what left the fixed-lag window
  bool keep_imu = false;              ///< the outcome holds all IMU samples, for dense output
  double output_voxel_m = 0.05;       ///< of the map made of the scans
  bool octomap = false;  ///< the outcome holds the occupancy of the place, and what has changed
};

/// How far a replay is, for the progress line.
struct ReplayProgress {
  std::optional<double> map_share;  ///< set while the map is loaded: read of its file, 0..1
  double share = 0;                 ///< of the recording's bytes, 0..1
  double speed_x_realtime = 0;      ///< so far; 0 while it is too early to tell
  std::uint64_t frames = 0;
  std::optional<double> left_s;  ///< that it may still take, as far as can be told
  const FrameDiagnostics* last_frame = nullptr;
  bool started = false;            ///< the first pose has been found
  std::optional<double> sigma_m;   ///< of the newest position, along its worst direction
  std::vector<std::string> notes;  ///< sentences that came up since the last call
};

/// What came out of a replay.
struct ReplayOutcome {
  Result result;
  UnusedCounts unused;
  std::vector<std::string> notes;  ///< sentences for the user, in the order they came up
  Findings findings;               ///< of the checks of the data; the notes have their sentences
  /// When a direction was lost and came back (see DirectionWatch), as matched during the run.
  std::vector<std::string> direction_changes;
  RunEnd end;
  ImuBuffer imu;  ///< all samples, if they were to be kept
  PointCloud map_of_scans;
  std::optional<PlaceChanges> place;      ///< if it was asked for and there is a trajectory
  std::vector<Point3f> prior_map_sample;  ///< relative to its origin (m), for the report's picture
  Vec3 prior_map_origin = Vec3::Zero();   ///< in the map frame (m)
  std::size_t prior_map_points = 0;
  std::size_t prior_map_planar = 0;
  std::vector<StageTimes> stages;
  double recording_s = 0;  ///< time span of the recording that was replayed
  double wall_s = 0;       ///< from opening the files to the final trajectory
};

/// Called after each scan, and whenever there is something to say.
using ReplayObserver = std::function<void(const ReplayProgress&)>;

/// Reads a recording and a prior map and makes the trajectory. Stops early, keeping what there is,
/// once `interrupt` becomes true. Throws IoError or ConfigError for what is wrong before the work
/// begins; trouble in the data is counted in the outcome.
ReplayOutcome replay(const ReplayOptions& options, const Config& config,
                     const std::atomic<bool>& interrupt, const ReplayObserver& observer);

}  // namespace paloc

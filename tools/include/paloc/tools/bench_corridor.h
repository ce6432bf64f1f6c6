#pragma once

#include <cstdint>
#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "paloc/config/config.h"
#include "paloc/tools/corridor_figures.h"
#include "paloc/tools/synth_survey.h"

namespace paloc {

/// What `paloc bench corridor` simulates.
struct BenchCorridorSettings {
  double free_m = 60;    ///< way over which the map leaves the corridor's axis open
  double angle_deg = 0;  ///< of the corridor against the map's x
  std::string sensor = "os1-128";
  double odometry_scale = 1.005;  ///< every step of the odometry is so many times too long
  std::uint64_t seed = 1;
  synth::SurveyModel survey;
};

/// Both trajectories of one estimator.
struct CorridorRun {
  bool degeneracy_handling = true;
  CorridorFigures online;  ///< of every pose as it was when its scan came, nothing later known
  CorridorFigures batch;
  std::vector<CorridorPose> online_poses, batch_poses;
  std::size_t map_factors = 0, refused = 0;
};

/// One figure against what it should be.
struct CorridorTarget {
  std::string name;
  double value = 0, limit = 0;
  bool met() const { return value <= limit; }
};

struct BenchCorridorResult {
  BenchCorridorSettings settings;
  FreeStretch stretch;
  std::size_t scans = 0;
  double odometry_drift_m = 0;  ///< along the axis over the stretch: what is to be beaten
  CorridorRun handled, unhandled;

  /// Of the run with degeneracy handling.
  std::vector<CorridorTarget> targets() const;
};

/// Called with the share of the work done, 0..1.
using BenchCorridorProgress = std::function<void(double share)>;

/// Walks from a room through a bare corridor to another room; both rooms are fixed by the map in
/// all directions, along the corridor nothing is but odometry and IMU. The same scans go to two
/// estimators, one of them without degeneracy handling. The scans' range noise in the matcher is
/// that of the sensor. Throws UsageError for an unknown sensor.
BenchCorridorResult benchCorridor(const BenchCorridorSettings& settings, const Config& config,
                                  const BenchCorridorProgress& progress);

/// The result as a table for people.
std::string tableOf(const BenchCorridorResult& result);

/// A row per pose of the four trajectories: errors along and across (left, up; m) with their
/// standard deviations, and the flag.
std::string posesCsv(const BenchCorridorResult& result);

/// As JSON: m, deg, standard deviations.
nlohmann::ordered_json jsonOf(const BenchCorridorResult& result);

}  // namespace paloc

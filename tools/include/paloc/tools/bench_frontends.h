#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "paloc/config/config.h"
#include "paloc/tools/odometry_figures.h"
#include "paloc/tools/stage_stopwatch.h"

namespace paloc {

/// What `paloc bench frontends` runs.
struct BenchFrontendsSettings {
  std::string frontend = "fast_lio";
  bool configured_imu = false;  ///< the IMU's noise is the configuration's, not the simulated one
  std::string scene = "building";
  std::string sensor = "os1-128";
  double duration_s = 60;
  unsigned seeds = 1;
  std::uint64_t first_seed = 1;
  std::filesystem::path log, truth;  ///< a recording and its truth (TUM), instead of simulated ones
};

/// One recording through the front-end.
struct FrontendRun {
  std::uint64_t seed = 0;
  OdometryFigures figures;
  std::size_t without_truth = 0;  ///< frames that the truth does not cover
  std::size_t map_bytes = 0;      ///< at the end
  std::vector<std::string> notes;
  bool diverged() const;  ///< more than a tenth of any 10 m, or of the whole way, is wrong
};

struct BenchFrontendsResult {
  BenchFrontendsSettings settings;
  std::vector<FrontendRun> runs;
  std::vector<StageTimes> stages;  ///< processor time per scan, of all runs
  double nees() const;             ///< per degree of freedom, over all frames of all runs
};

/// Runs a front-end alone: simulated recordings, one for each seed, or a given one, are put through
/// it, and its odometry is compared with the truth. Throws UsageError, IoError or ConfigError for
/// what does not exist.
BenchFrontendsResult benchFrontends(const BenchFrontendsSettings& settings, const Config& config,
                                    const std::function<void(double)>& progress);

/// The result as a table for people.
std::string tableOf(const BenchFrontendsResult& result);

/// As JSON: m, rad, shares from 0 to 1, ms.
nlohmann::ordered_json jsonOf(const BenchFrontendsResult& result);

}  // namespace paloc

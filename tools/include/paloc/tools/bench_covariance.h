#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "paloc/config/config.h"
#include "paloc/tools/normalized_errors.h"

namespace paloc {

struct BenchCovarianceSettings {
  /// Scenes of paloc synth, each with what is changed there after "+": "building+missing-part".
  std::vector<std::string> places{"building", "corridor-30", "building+missing-part"};
  std::string sensor = "vlp-16";
  std::string frontend = "recorded";
  unsigned seeds = 50;
  std::uint64_t first_seed = 1;
  double duration_s = 40;
  double map_bias_m = 0.005;    ///< of whole surfaces, one sigma; configured as plane_bias_m
  bool configured_imu = false;  ///< the IMU's noise is the configuration's, not the simulated one
};

/// Of one place, all seeds together.
struct PlaceCovariance {
  NormalizedErrors all;
  std::map<std::string, NormalizedErrors> by_flag;
  std::vector<double> nees_per_seed;  ///< of the pose, per degree of freedom
  std::size_t unusable = 0;           ///< poses whose covariance is not positive definite
  std::size_t failed = 0;             ///< seeds without a trajectory
};

struct BenchCovarianceResult {
  std::vector<std::pair<std::string, PlaceCovariance>> places;
};

/// Simulates a recording and a map for each seed, replays it with the simulated bias and IMU noise
/// as settings, and compares errors with covariances over whole trajectories. In a temporary
/// folder. `progress` is called with the share done.
BenchCovarianceResult benchCovariance(const BenchCovarianceSettings& settings, Config config,
                                      const std::function<void(double)>& progress);

/// The result as a table for people.
std::string tableOf(const BenchCovarianceResult& result);

/// The result as JSON: m, rad.
nlohmann::ordered_json jsonOf(const BenchCovarianceResult& result);

}  // namespace paloc

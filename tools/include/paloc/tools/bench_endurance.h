#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "paloc/core/trajectory.h"

namespace paloc {

struct BenchEnduranceSettings {
  std::size_t updates = 1'000'000;
  double lag_s = 5;
  unsigned seed = 1;
};

/// One tenth of an endurance run.
struct EnduranceStretch {
  std::size_t updates = 0;        ///< since the beginning, at its end
  double p50_ms = 0, p99_ms = 0;  ///< of an update, on the processor
  double resident_mb = 0;         ///< memory of the process at its end
  double position_rmse_m = 0;     ///< of the newest state as it appears
  double nees_per_dof = 0;        ///< of its pose
};

struct BenchEnduranceResult {
  double lag_s = 0;
  std::vector<EnduranceStretch> stretches;
  RepairCounts repairs;
  std::uint64_t refused_as_too_old = 0;
  double wall_s = 0;
};

/// Runs the fixed-lag smoother on a simulated drive (simulated_drive.h) that no one stores. An
/// update is one node: preintegration, its factors, linearization, solution, late factors and the
/// covariance of the newest state.
BenchEnduranceResult benchEndurance(const BenchEnduranceSettings& settings);

/// The result as a table for people.
std::string tableOf(const BenchEnduranceResult& result);

/// The result as JSON: m, ms, s, MB.
nlohmann::ordered_json jsonOf(const BenchEnduranceResult& result);

}  // namespace paloc

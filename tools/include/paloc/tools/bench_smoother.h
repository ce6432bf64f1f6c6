#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "paloc/core/trajectory.h"
#include "paloc/frontends/tum_file.h"
#include "paloc/tools/error_statistics.h"
#include "paloc/tools/smoother_problem.h"

namespace paloc {

struct BenchSmootherSettings {
  enum class Mode { kOnline, kBatch, kBoth };
  Mode mode = Mode::kBoth;
  double lag_s = 5;
};

/// Errors of an estimate against the truth.
struct StateErrors {
  ErrorStatistics position_m, rotation_rad;
};

/// Times of one kind of work over all updates, in ms.
struct TimeStatistics {
  double p50 = 0, p99 = 0, max = 0;
};

struct BenchSmootherResult {
  std::size_t nodes = 0;
  double lag_s = 0;

  // An update: preintegration, its factors, linearization, solution and the newest covariance.
  TimeStatistics update_ms;      ///< by the wall clock
  TimeStatistics update_cpu_ms;  ///< time on the processor: without what others did on the machine
  // Its parts, on the processor.
  TimeStatistics preintegration_ms;  ///< and making the factors
  TimeStatistics smoother_ms;        ///< FixedLagSmoother::add
  TimeStatistics linearization_ms;   ///< of the new node once, measured apart; part of smoother_ms
  TimeStatistics covariance_ms;      ///< of the newest state

  StateErrors newest;                ///< as it appears
  StateErrors leaving;               ///< as it leaves the window
  std::optional<StateErrors> batch;  ///< if it was asked for
  double batch_time_s = 0;
  int batch_iterations = 0;
  bool batch_converged = false;
  RepairCounts repairs;
  std::size_t relinearized = 0;
  std::size_t late_refused = 0;  ///< map measurements older than the window
  double peak_rss_mb = 0;        ///< of the process

  std::vector<StampedPose> trajectory;  ///< the batch's, or the online one if there is no batch
};

/// Smooths the problem node by node, as an online estimator would, and then, if asked, as a batch
/// that starts from what the window left.
BenchSmootherResult benchSmoother(const SmootherProblem& problem,
                                  const BenchSmootherSettings& settings);

/// The result as a table for people.
std::string tableOf(const BenchSmootherResult& result);

/// The result as JSON: m, rad, ms, s, MB. What was not computed is null.
nlohmann::ordered_json jsonOf(const BenchSmootherResult& result);

}  // namespace paloc

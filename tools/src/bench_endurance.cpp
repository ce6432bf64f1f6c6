#include "paloc/tools/bench_endurance.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "paloc/core/fixed_lag_smoother.h"
#include "paloc/tools/peak_memory.h"
#include "paloc/tools/quantile.h"
#include "problem_nodes.h"
#include "simulated_drive.h"
#include "work_stopwatch.h"

namespace paloc {
namespace {

constexpr std::size_t kStretches = 10;

/// Sums over one stretch.
class StretchSums {
 public:
  explicit StretchSums(std::size_t updates) { times_ms_.reserve(updates); }

  void add(double time_ms, const NodeEstimate& newest, const Pose& truth) {
    times_ms_.push_back(time_ms);
    const Eigen::Matrix<double, 6, 1> error = boxminus(newest.state.T_map_body, truth);
    const Eigen::Matrix<double, 6, 6> covariance = newest.covariance.topLeftCorner<6, 6>();
    squares_ += error.head<3>().squaredNorm();
    nees_ += error.dot(covariance.ldlt().solve(error)) / 6;
  }

  EnduranceStretch result(std::size_t updates) const {
    const auto count = static_cast<double>(times_ms_.size());
    return {updates,      quantile(times_ms_, 0.5),    quantile(times_ms_, 0.99),
            residentMb(), std::sqrt(squares_ / count), nees_ / count};
  }

  void clear() {
    times_ms_.clear();
    squares_ = nees_ = 0;
  }

 private:
  std::vector<double> times_ms_;
  double squares_ = 0, nees_ = 0;
};

SmootherSettings smootherSettings(double lag_s) {
  SmootherSettings settings;
  settings.lag_s = lag_s;
  settings.covariance_of_leaving = false;
  return settings;
}

// One node more; the estimate of it.
NodeEstimate update(FixedLagSmoother& smoother, ChainNode node, const SmootherProblem::Node& source,
                    std::size_t k) {
  smoother.add(std::move(node));
  for (const SmootherProblem::MapMeasurement& map : source.map) {
    if (map.node != k) smoother.addFactor(map.node, MapFactor(map.T_map_body, map.information));
  }
  return smoother.newest();
}

}  // namespace

BenchEnduranceResult benchEndurance(const BenchEnduranceSettings& settings) {
  BenchEnduranceResult result;
  result.lag_s = settings.lag_s;
  FixedLagSmoother smoother(smootherSettings(settings.lag_s));
  SimulatedDrive drive(settings.seed);
  const std::size_t stretch = std::max<std::size_t>(settings.updates / kStretches, 1);
  StretchSums sums(stretch + kStretches);
  SmootherProblem::Node before;
  State last;
  const WorkStopwatch whole;
  for (std::size_t k = 0; k < settings.updates; ++k) {
    SmootherProblem::Node source = drive.next();
    const WorkStopwatch watch;
    ChainNode node =
        k == 0 ? firstProblemNode(source) : nextProblemNode(drive.noise(), before, source, k, last);
    const NodeEstimate newest = update(smoother, std::move(node), source, k);
    sums.add(watch.cpu_ms(), newest, source.T_map_body_true);
    smoother.takeLeft();
    last = newest.state;
    before = std::move(source);
    const bool full = (k + 1) % stretch == 0 && result.stretches.size() + 1 < kStretches;
    if (!full && k + 1 < settings.updates) continue;
    result.stretches.push_back(sums.result(k + 1));
    sums.clear();
  }
  result.wall_s = 1e-3 * whole.wall_ms();
  result.repairs = smoother.repairs();
  result.refused_as_too_old = smoother.refusedAsTooOld();
  return result;
}

}  // namespace paloc

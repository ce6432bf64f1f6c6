#include "paloc/tools/bench_smoother.h"

#include <algorithm>

#include "paloc/core/batch_smoother.h"
#include "paloc/core/fixed_lag_smoother.h"
#include "paloc/tools/peak_memory.h"
#include "paloc/tools/quantile.h"
#include "problem_nodes.h"
#include "work_stopwatch.h"

namespace paloc {
namespace {

TimeStatistics timeStatistics(const std::vector<double>& times_ms) {
  return {quantile(times_ms, 0.5), quantile(times_ms, 0.99), quantile(times_ms, 1)};
}

/// Collects the errors of poses against the truth.
class Scorer {
 public:
  void add(const Pose& pose, const Pose& truth) {
    position_m_.push_back((pose.position - truth.position).norm());
    rotation_rad_.push_back(so3::log(truth.rotation.transpose() * pose.rotation).norm());
  }
  StateErrors errors() const {
    return {errorStatistics(position_m_), errorStatistics(rotation_rad_)};
  }

 private:
  std::vector<double> position_m_, rotation_rad_;
};

SmootherSettings smootherSettings(double lag_s) {
  SmootherSettings settings;
  settings.lag_s = lag_s;
  settings.covariance_of_leaving = false;  // nobody asks for it here
  return settings;
}

/// Feeds a fixed-lag smoother with the nodes of a problem, and measures.
class OnlineRun {
 public:
  OnlineRun(const SmootherProblem& problem, const BenchSmootherSettings& settings)
      : problem_(problem),
        keep_nodes_(settings.mode != BenchSmootherSettings::Mode::kOnline),
        smoother_(smootherSettings(settings.lag_s)) {}

  void run() {
    for (std::size_t k = 0; k < problem_.nodes.size(); ++k) step(k);
    states_.resize(problem_.nodes.size());
    for (const NodeEstimate& rest : smoother_.window(false)) states_[rest.id] = rest.state;
  }
  void report(BenchSmootherResult& result) const;

  /// The estimates as they left the window, and at the end those still in it.
  const std::vector<State>& states() const { return states_; }
  /// All nodes with all their factors, if they were to be kept.
  std::vector<ChainNode>& keptNodes() { return kept_; }

 private:
  void step(std::size_t k);
  void update(std::size_t k, ChainNode node, double made_wall_ms, double made_cpu_ms);
  void measureLinearization(const ChainNode& node);
  void addLateFactors(std::size_t k);
  void takeLeft();

  const SmootherProblem& problem_;
  bool keep_nodes_;
  FixedLagSmoother smoother_;
  State last_;
  ChainNode previous_;
  std::vector<State> states_;
  std::vector<ChainNode> kept_;
  Scorer newest_, leaving_;
  std::vector<double> wall_, cpu_, making_, adding_, linearization_, covariance_;
  std::size_t relinearized_ = 0, late_refused_ = 0;
};

void OnlineRun::step(std::size_t k) {
  const WorkStopwatch watch;
  const SmootherProblem::Node& source = problem_.nodes[k];
  ChainNode node = k == 0
                       ? firstProblemNode(source)
                       : nextProblemNode(problem_.noise, problem_.nodes[k - 1], source, k, last_);
  const double wall_ms = watch.wall_ms(), cpu_ms = watch.cpu_ms();
  measureLinearization(node);
  previous_ = node;
  if (keep_nodes_) kept_.push_back(node);
  update(k, std::move(node), wall_ms, cpu_ms);
  takeLeft();
}

void OnlineRun::update(std::size_t k, ChainNode node, double made_wall_ms, double made_cpu_ms) {
  const WorkStopwatch watch;
  relinearized_ += static_cast<std::size_t>(smoother_.add(std::move(node)).relinearized);
  addLateFactors(k);
  const double added_ms = watch.cpu_ms();
  const NodeEstimate newest = smoother_.newest();
  const double cpu_ms = watch.cpu_ms(), wall_ms = watch.wall_ms();
  wall_.push_back(made_wall_ms + wall_ms);
  cpu_.push_back(made_cpu_ms + cpu_ms);
  making_.push_back(made_cpu_ms);
  adding_.push_back(added_ms);
  covariance_.push_back(cpu_ms - added_ms);
  last_ = newest.state;
  newest_.add(last_.T_map_body, problem_.nodes[k].T_map_body_true);
}

// The smoother itself reads no clock: so the same work once more, apart.
void OnlineRun::measureLinearization(const ChainNode& node) {
  if (smoother_.empty()) return;
  const WorkStopwatch watch;
  const ChainBlock block = linearize(&previous_, node);
  if (block.usable()) linearization_.push_back(watch.cpu_ms());
}

void OnlineRun::addLateFactors(std::size_t k) {
  for (const SmootherProblem::MapMeasurement& map : problem_.nodes[k].map) {
    if (map.node == k) continue;
    const MapFactor factor(map.T_map_body, map.information);
    const UpdateSummary summary = smoother_.addFactor(map.node, factor);
    relinearized_ += static_cast<std::size_t>(summary.relinearized);
    if (summary.status == UpdateSummary::Status::kRefused) ++late_refused_;
    if (keep_nodes_) kept_[map.node].node_factors.push_back(factor);
  }
}

void OnlineRun::takeLeft() {
  for (const NodeEstimate& left : smoother_.takeLeft()) {
    leaving_.add(left.state.T_map_body, problem_.nodes[left.id].T_map_body_true);
    states_.resize(left.id + 1);
    states_[left.id] = left.state;
  }
}

void OnlineRun::report(BenchSmootherResult& result) const {
  result.update_ms = timeStatistics(wall_);
  result.update_cpu_ms = timeStatistics(cpu_);
  result.preintegration_ms = timeStatistics(making_);
  result.smoother_ms = timeStatistics(adding_);
  result.linearization_ms = timeStatistics(linearization_);
  result.covariance_ms = timeStatistics(covariance_);
  result.newest = newest_.errors();
  result.leaving = leaving_.errors();
  result.repairs = smoother_.repairs();
  result.relinearized = relinearized_;
  result.late_refused = late_refused_;
}

void runBatch(const SmootherProblem& problem, OnlineRun& online, BenchSmootherResult& result) {
  std::vector<ChainNode> nodes = std::move(online.keptNodes());
  for (std::size_t k = 0; k < nodes.size(); ++k) nodes[k].state = online.states()[k];
  const WorkStopwatch watch;
  const BatchSummary summary = smoothBatch(nodes, SmootherSettings());
  result.batch_time_s = 1e-3 * watch.wall_ms();
  result.batch_iterations = summary.iterations;
  result.batch_converged = summary.status == BatchSummary::Status::kConverged;
  Scorer scorer;
  for (std::size_t k = 0; k < nodes.size(); ++k) {
    scorer.add(nodes[k].state.T_map_body, problem.nodes[k].T_map_body_true);
    result.trajectory.push_back({nodes[k].t_ns, nodes[k].state.T_map_body});
  }
  result.batch = scorer.errors();
}

}  // namespace

BenchSmootherResult benchSmoother(const SmootherProblem& problem,
                                  const BenchSmootherSettings& settings) {
  BenchSmootherResult result;
  result.nodes = problem.nodes.size();
  result.lag_s = settings.lag_s;
  OnlineRun online(problem, settings);
  online.run();
  online.report(result);
  if (settings.mode == BenchSmootherSettings::Mode::kOnline) {
    for (std::size_t k = 0; k < result.nodes; ++k) {
      result.trajectory.push_back({problem.nodes[k].t_ns, online.states()[k].T_map_body});
    }
  } else {
    runBatch(problem, online, result);
  }
  result.peak_rss_mb = peakRssMb();
  return result;
}

}  // namespace paloc

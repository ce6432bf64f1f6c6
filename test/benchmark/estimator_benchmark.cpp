// Google Benchmarks of the estimator's parts:
//   build/bin/paloc_benchmarks [--benchmark_filter=...]
#include <benchmark/benchmark.h>

#include "paloc/core/batch_smoother.h"
#include "paloc/core/fixed_lag_smoother.h"
#include "simulated_chain.h"

namespace paloc {
namespace {

constexpr double kNode_s = SimulatedChain::kDt_s;

// As long a chain as asked for, with a map factor and an odometry at each node.
std::vector<ChainNode> chainOf(std::size_t nodes) {
  SimulatedChain chain(1);
  std::vector<ChainNode> all{chain.first()};
  for (std::size_t k = 1; k < nodes; ++k) {
    ChainNode node = chain.next(chain.truth);
    node.edge_factors.emplace_back(chain.odometry());
    node.node_factors.emplace_back(chain.map(chain.truth));
    all.push_back(std::move(node));
  }
  return all;
}

void preintegrateOneSample(benchmark::State& state) {
  const ImuNoise noise;
  Preintegration p(noise, Vec3(0.01, 0.02, -0.01), Vec3(0.001, 0.002, 0.003));
  for (auto _ : state) {
    p.integrate(Vec3(0.3, -0.2, 9.8), Vec3(0.1, 0.2, -0.3), 0.005);
    if (p.dt_s > 0.1) p = Preintegration(noise, Vec3(0.01, 0.02, -0.01), Vec3(0.001, 0.002, 0.003));
    benchmark::DoNotOptimize(p);
  }
}
BENCHMARK(preintegrateOneSample);

// Linearizes a node that has this one factor only, on the node or on its edge.
void linearizeFactor(benchmark::State& state, const EdgeFactor* edge, const NodeFactor* own,
                     const std::vector<ChainNode>& chain) {
  ChainNode node;
  node.t_ns = chain[1].t_ns;
  node.state = chain[1].state;
  if (edge) node.edge_factors.push_back(*edge);
  if (own) node.node_factors.push_back(*own);
  for (auto _ : state) {
    const ChainBlock block = linearize(&chain[0], node);
    benchmark::DoNotOptimize(block.cost);
  }
}

void linearizeWholeNode(benchmark::State& state) {
  const std::vector<ChainNode> chain = chainOf(2);
  for (auto _ : state) {
    const ChainBlock block = linearize(&chain[0], chain[1]);
    benchmark::DoNotOptimize(block.cost);
  }
}
BENCHMARK(linearizeWholeNode);

// One update of a window that is full, whose length in seconds is the argument.
void updateFixedLag(benchmark::State& state) {
  SmootherSettings settings;
  settings.lag_s = static_cast<double>(state.range(0));
  settings.covariance_of_leaving = false;
  FixedLagSmoother smoother(settings);
  SimulatedChain chain(1);
  smoother.add(chain.first());
  const auto next = [&] {
    ChainNode node = chain.next(chain.truth);
    node.edge_factors.emplace_back(chain.odometry());
    node.node_factors.emplace_back(chain.map(chain.truth));
    return node;
  };
  const auto full = static_cast<int>(settings.lag_s / kNode_s) + 10;
  for (int k = 0; k < full; ++k) smoother.add(next());
  for (auto _ : state) {
    state.PauseTiming();
    ChainNode node = next();
    state.ResumeTiming();
    smoother.add(std::move(node));
    state.PauseTiming();
    smoother.takeLeft();
    state.ResumeTiming();
  }
}
BENCHMARK(updateFixedLag)->Arg(5)->Arg(20)->Unit(benchmark::kMicrosecond);

// Before the first node leaves it.
FixedLagSmoother fullWindow(double lag_s) {
  SmootherSettings settings;
  settings.lag_s = lag_s;
  FixedLagSmoother smoother(settings);
  for (ChainNode& node : chainOf(static_cast<std::size_t>(lag_s / kNode_s))) {
    smoother.add(std::move(node));
  }
  return smoother;
}

void newestCovariance(benchmark::State& state) {
  const FixedLagSmoother smoother = fullWindow(static_cast<double>(state.range(0)));
  for (auto _ : state) {
    const NodeEstimate newest = smoother.newest();
    benchmark::DoNotOptimize(newest.covariance(0, 0));
  }
}
BENCHMARK(newestCovariance)->Arg(5)->Arg(20)->Unit(benchmark::kMicrosecond);

void windowCovariances(benchmark::State& state) {
  const FixedLagSmoother smoother = fullWindow(static_cast<double>(state.range(0)));
  for (auto _ : state) {
    const std::vector<NodeEstimate> window = smoother.window(true);
    benchmark::DoNotOptimize(window.data());
  }
}
BENCHMARK(windowCovariances)->Arg(5)->Arg(20)->Unit(benchmark::kMicrosecond);

// With all covariances.
void smoothAsBatch(benchmark::State& state) {
  const std::vector<ChainNode> chain = chainOf(static_cast<std::size_t>(state.range(0)));
  for (auto _ : state) {
    std::vector<ChainNode> nodes = chain;
    const BatchSummary summary = smoothBatch(nodes, SmootherSettings());
    if (summary.status != BatchSummary::Status::kConverged) state.SkipWithError("not converged");
  }
}
BENCHMARK(smoothAsBatch)->Arg(1000)->Arg(20000)->Unit(benchmark::kMillisecond);

void registerFactors() {
  static const std::vector<ChainNode> chain = chainOf(2);
  SimulatedChain simulated(2);
  simulated.next(simulated.truth);
  Vec6 variances;
  variances << Vec3::Constant(1e-4), Vec3::Constant(1e-6);
  static const std::vector<std::pair<const char*, EdgeFactor>> edges{
      {"lidar odometry", simulated.odometry()},
      {"IMU", chain[1].edge_factors[0]},
      {"bias walk", BiasWalkFactor(ImuNoise(), kNode_s)},
      {"constant gravity", ConstantGravityFactor(1e-6, kNode_s)},
      {"no motion", NoMotionFactor(0.002, 0.001)},
      {"velocity", VelocityFactor(kNode_s, 0.5)}};
  static const std::vector<std::pair<const char*, NodeFactor>> own{
      {"prior", chain[0].node_factors[0]},
      {"map", simulated.map(simulated.truth)},
      {"zero velocity", ZeroVelocityFactor(0.01)},
      {"gravity", GravityFactor(Vec3(0.1, 0.2, 9.8), 0.005, 0.001)}};
  for (const auto& [name, factor] : edges) {
    benchmark::RegisterBenchmark((std::string("linearize ") + name).c_str(), linearizeFactor,
                                 &factor, nullptr, chain);
  }
  for (const auto& [name, factor] : own) {
    benchmark::RegisterBenchmark((std::string("linearize ") + name).c_str(), linearizeFactor,
                                 nullptr, &factor, chain);
  }
}

}  // namespace
}  // namespace paloc

int main(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
  paloc::registerFactors();
  benchmark::RunSpecifiedBenchmarks();
  benchmark::Shutdown();
}

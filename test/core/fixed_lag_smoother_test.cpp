#include "paloc/core/fixed_lag_smoother.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <limits>

#include "paloc/core/batch_smoother.h"
#include "simulated_chain.h"

namespace paloc {
namespace {

using tangent::kDim;
using Status = UpdateSummary::Status;

SmootherSettings lagOf(double lag_s) {
  SmootherSettings settings;
  settings.lag_s = lag_s;
  return settings;
}

// Largest distance of two states, every component in its own unit.
double distance(const State& a, const State& b) { return boxminus(a, b).cwiseAbs().maxCoeff(); }

// Largest difference between the smoother's estimates and those of a dense factorization of the
// window as it is linearized.
double differenceFromRefactorization(const FixedLagSmoother& smoother) {
  const std::vector<ChainNode> nodes = smoother.linearizedWindow();
  const DenseSystem system(nodes);
  // In long double, so that the difference is the smoother's own rounding.
  using Matrix = Eigen::Matrix<long double, Eigen::Dynamic, Eigen::Dynamic>;
  using Vector = Eigen::Matrix<long double, Eigen::Dynamic, 1>;
  const Vector solution =
      Matrix(system.hessian.cast<long double>()).ldlt().solve(Vector(system.b.cast<long double>()));
  const Eigen::VectorXd delta = solution.cast<double>();
  const std::vector<NodeEstimate> window = smoother.window(false);
  double worst = 0;
  for (std::size_t k = 0; k < nodes.size(); ++k) {
    const StateVector d = delta.segment<kDim>(static_cast<Eigen::Index>(k) * kDim);
    worst = std::max(worst, distance(window[k].state, boxplus(nodes[k].state, d)));
  }
  return worst;
}

/// A problem that is linear: a body that does not turn, positions, velocities and random walks.
class LinearProblem {
 public:
  ChainNode next() {
    ChainNode node;
    node.t_ns = nsFromSeconds(0.1) * count_;
    node.state.T_map_body.position = random_.vector(3);  // the guess may be anything
    if (count_ == 0) {
      node.node_factors.push_back(PriorFactor::fromSigmas(State(), StateVector::Constant(0.5)));
    } else {
      node.edge_factors = {VelocityFactor(0.1, 0.2), BiasWalkFactor(ImuNoise(), 0.1),
                           ConstantGravityFactor(1e-3, 0.1)};
    }
    Vec6 information;
    information << Vec3::Constant(count_ % 3 == 0 ? 100 : 0), Vec3::Constant(1e4);
    const Pose measured{Vec3(0.1 * count_, 0, 0) + random_.vector(0.1), Mat3::Identity()};
    node.node_factors.push_back(MapFactor(measured, information.asDiagonal()));
    node.node_factors.push_back(ZeroVelocityFactor(2.0));
    ++count_;
    return node;
  }

 private:
  int count_ = 0;
  RandomStates random_{1};
};

TEST(FixedLagSmoother, EqualsTheBatchWhereAllIsLinear) {
  LinearProblem problem;
  FixedLagSmoother smoother(lagOf(1.0));
  std::vector<ChainNode> all;
  std::size_t compared = 0;
  for (int k = 0; k < 80; ++k) {
    all.push_back(problem.next());
    ASSERT_EQ(smoother.add(all.back()).status, Status::kGood);
    std::vector<ChainNode> batch = all;
    const BatchSummary summary = smoothBatch(batch, SmootherSettings());
    const NodeEstimate newest = smoother.newest();
    EXPECT_LT(distance(newest.state, batch.back().state), 1e-9) << k;
    EXPECT_LT((newest.covariance - summary.covariances.back()).norm(),
              1e-8 * newest.covariance.norm());
    for (const NodeEstimate& left : smoother.takeLeft()) {
      EXPECT_LT(distance(left.state, batch[left.id].state), 1e-9) << k;
      EXPECT_LT((left.covariance - summary.covariances[left.id]).norm(),
                1e-8 * left.covariance.norm());
      ++compared;
    }
    for (const NodeEstimate& here : smoother.window(true)) {
      EXPECT_LT(distance(here.state, batch[here.id].state), 1e-9) << k;
      EXPECT_LT((here.covariance - summary.covariances[here.id]).norm(),
                1e-8 * here.covariance.norm());
    }
  }
  EXPECT_EQ(compared, 80u - 11u);
}

TEST(FixedLagSmoother, EqualsAFullRefactorizationOverLongRandomRuns) {
  const char* many = std::getenv("PALOC_TEST_UPDATES");  // each one is checked if it is set
  const int updates = many ? std::atoi(many) : 600, every = many ? 1 : 7;
  SimulatedChain chain(2);
  SmootherSettings settings = lagOf(1.5);
  // Half the usual thresholds, so that linearization points move all the time.
  settings.relinearize_position_m = 0.005;
  settings.relinearize_rotation_rad = 0.0005;
  settings.relinearize_velocity_mps = 0.01;
  FixedLagSmoother smoother(settings);
  smoother.add(chain.first());
  std::vector<std::pair<NodeId, State>> truths;
  int relinearized = 0, late = 0;
  for (int k = 1; k < updates; ++k) {
    ChainNode node = chain.next(smoother.newest().state);
    truths.push_back({static_cast<NodeId>(k), chain.truth});
    const auto chance = [&](double p) { return chain.random.uniform(0, 1) < p; };
    const bool no_imu = chance(0.1);
    if (no_imu) {  // a gap, that the odometry bridges
      node.edge_factors.erase(node.edge_factors.begin());
      node.edge_factors.push_back(VelocityFactor(SimulatedChain::kDt_s, 0.5));
    }
    if (no_imu || chance(0.7)) node.edge_factors.push_back(chain.odometry());
    if (chance(0.5)) node.node_factors.push_back(chain.map(chain.truth));
    relinearized += smoother.add(std::move(node)).relinearized;
    if (chance(0.3)) {
      const std::size_t back = chain.random.below(std::min<std::size_t>(truths.size(), 20));
      const auto& [id, state] = truths[truths.size() - 1 - back];
      const bool inside = id + smoother.size() > smoother.newestId();
      const UpdateSummary summary = smoother.addFactor(id, chain.map(state));
      EXPECT_EQ(summary.status == Status::kRefused, !inside);
      relinearized += summary.relinearized;
      late += inside ? 1 : 0;
    }
    if (k % every == 0) {
      ASSERT_LT(differenceFromRefactorization(smoother), 1e-9) << "update " << k;
    }
  }
  EXPECT_GT(relinearized, updates / 2);
  EXPECT_GT(late, updates / 10);
  EXPECT_LT((smoother.newest().state.T_map_body.position - chain.truth.T_map_body.position).norm(),
            0.5);
}

TEST(FixedLagSmoother, KeepsTheLagAndNamesWhatLeaves) {
  LinearProblem problem;
  FixedLagSmoother smoother(lagOf(0.5));
  EXPECT_TRUE(smoother.empty());
  NodeId expected = 0;
  for (NodeId k = 0; k < 30; ++k) {
    smoother.add(problem.next());
    EXPECT_EQ(smoother.newestId(), k);
    EXPECT_EQ(smoother.size(), std::min<std::size_t>(k + 1, 6));  // 0.5 s and the newest
    for (const NodeEstimate& left : smoother.takeLeft()) {
      EXPECT_EQ(left.id, expected++);
      EXPECT_GT(left.covariance.diagonal().minCoeff(), 0);
    }
  }
  EXPECT_EQ(expected, 24u);
}

TEST(FixedLagSmoother, RefusesWhatItCannotUse) {
  LinearProblem problem;
  FixedLagSmoother smoother(lagOf(0.5));
  ChainNode node = problem.next();
  const ChainNode first = node;
  node.state.v_map.x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(smoother.add(node).status, Status::kRefused);
  EXPECT_TRUE(smoother.empty());
  EXPECT_EQ(smoother.add(first).status, Status::kGood);
  EXPECT_EQ(smoother.add(first).status, Status::kRefused) << "the same time again";
  for (int k = 0; k < 10; ++k) smoother.add(problem.next());
  EXPECT_EQ(smoother.add(first).status, Status::kRefused) << "time backwards";
  const std::size_t size = smoother.size();
  EXPECT_EQ(smoother.addFactor(0, ZeroVelocityFactor(1)).status, Status::kRefused) << "has left";
  EXPECT_EQ(smoother.addFactor(99, ZeroVelocityFactor(1)).status, Status::kRefused);
  EXPECT_EQ(smoother.size(), size);
  EXPECT_EQ(smoother.repairs().total(), 0u);
}

TEST(FixedLagSmoother, DropsAndCountsFactorsThatAreNotFinite) {
  SimulatedChain chain(3);
  FixedLagSmoother smoother(lagOf(1)), healthy(lagOf(1));
  const ChainNode first = chain.first();
  smoother.add(first);
  healthy.add(first);
  for (std::uint64_t k = 0; k < 30; ++k) {
    ChainNode node = chain.next(healthy.newest().state);
    node.node_factors.push_back(chain.map(chain.truth));
    healthy.add(node);
    Pose nowhere;
    nowhere.position.x() = std::numeric_limits<double>::quiet_NaN();
    node.node_factors.push_back(MapFactor(nowhere, Mat6::Identity()));
    node.edge_factors.insert(node.edge_factors.begin(),
                             LidarOdometryFactor(nowhere, Mat6::Identity()));
    EXPECT_EQ(smoother.add(node).status, Status::kRepaired);
    EXPECT_EQ(smoother.repairs().factors_dropped, 2 * (k + 1));
  }
  EXPECT_EQ(distance(smoother.newest().state, healthy.newest().state), 0);
  const MapFactor bad(Pose(), Mat6::Constant(std::numeric_limits<double>::infinity()));
  EXPECT_EQ(smoother.addFactor(smoother.newestId(), bad).status, Status::kRefused);
  EXPECT_EQ(smoother.repairs().factors_dropped, 61u);
  EXPECT_LT(differenceFromRefactorization(smoother), 1e-9);
}

TEST(FixedLagSmoother, RepairsANodeThatNothingHoldsAndRecovers) {
  SimulatedChain chain(4);
  FixedLagSmoother smoother(lagOf(2));
  smoother.add(chain.first());
  for (int k = 1; k < 60; ++k) {
    ChainNode node = chain.next(smoother.newest().state);
    node.node_factors.push_back(chain.map(chain.truth));
    if (k == 20) {  // a hole: nothing joins it to the past, and no map
      node.edge_factors.clear();
      node.node_factors.clear();
    }
    const UpdateSummary summary = smoother.add(std::move(node));
    EXPECT_EQ(summary.status, k == 20 ? Status::kRepaired : Status::kGood) << k;
    EXPECT_TRUE(smoother.newest().covariance.allFinite());
  }
  EXPECT_EQ(smoother.repairs().damped, 1u);
  EXPECT_EQ(smoother.repairs().reanchored, 0u);
  const State estimate = smoother.newest().state;
  EXPECT_LT((estimate.T_map_body.position - chain.truth.T_map_body.position).norm(), 0.1);
}

TEST(FixedLagSmoother, SurvivesAbsurdMeasurementsAndHoles) {
  SimulatedChain chain(5);
  FixedLagSmoother smoother(lagOf(1));
  smoother.add(chain.first());
  for (int k = 1; k < 240; ++k) {
    ChainNode node = chain.next(smoother.newest().state);
    node.node_factors.push_back(chain.map(chain.truth));
    if (k > 30 && k < 130) continue;          // a hole of ten seconds
    if (k == 130) node.edge_factors.clear();  // that nothing bridges
    Mat6 absurd = Mat6::Identity();
    if (k == 20) absurd *= 1e40;
    if (k == 21) absurd *= -1;
    if (k == 20 || k == 21) {
      node.node_factors.push_back(MapFactor(chain.random.pose(), absurd));
    }
    if (k == 22) node.edge_factors.push_back(LidarOdometryFactor(Pose(), Mat6::Zero()));
    EXPECT_NO_THROW(smoother.add(std::move(node)));
    ASSERT_TRUE(smoother.newest().state.T_map_body.position.allFinite()) << k;
  }
  EXPECT_EQ(smoother.repairs().factors_dropped, 2u);
  EXPECT_GT(smoother.repairs().damped, 0u);
  const State estimate = smoother.newest().state;
  EXPECT_LT((estimate.T_map_body.position - chain.truth.T_map_body.position).norm(), 0.2);
}

}  // namespace
}  // namespace paloc

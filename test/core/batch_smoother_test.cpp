#include "paloc/core/batch_smoother.h"

#include <gtest/gtest.h>

#include <Eigen/LU>

#include "simulated_chain.h"

namespace paloc {
namespace {

using tangent::kDim;
using Status = BatchSummary::Status;

struct Recording {
  std::vector<ChainNode> nodes;
  std::vector<State> truth;
};

// Nodes in dead reckoning, with a map factor at every `map_every`-th.
Recording record(unsigned seed, int count, int map_every, RobustKernel kernel = {}) {
  SimulatedChain chain(seed);
  Recording r;
  r.nodes.push_back(chain.firstDrawn());
  r.truth.push_back(chain.truth);
  for (int k = 1; k < count; ++k) {
    ChainNode node = chain.next(r.nodes.back().state);
    if (k % map_every == 0) node.node_factors.push_back(chain.map(chain.truth));
    if (kernel.kind != RobustKernel::Kind::kNone && k % 7 == 0) {
      Pose wrong = chain.truth.T_map_body;
      wrong.position += chain.random.vector(2);
      node.node_factors.push_back(MapFactor(wrong, 2500 * Mat6::Identity(), kernel));
    }
    r.nodes.push_back(node);
    r.truth.push_back(chain.truth);
  }
  return r;
}

double rmse(const Recording& r) {
  double sum = 0;
  for (std::size_t k = 0; k < r.nodes.size(); ++k) {
    sum += (r.nodes[k].state.T_map_body.position - r.truth[k].T_map_body.position).squaredNorm();
  }
  return std::sqrt(sum / static_cast<double>(r.nodes.size()));
}

TEST(BatchSmoother, EndsWhereTheGradientVanishes) {
  Recording r = record(1, 300, 1);
  const double before = rmse(r);
  const BatchSummary summary = smoothBatch(r.nodes, SmootherSettings());
  EXPECT_EQ(summary.status, Status::kConverged);
  EXPECT_LT(summary.final_cost, summary.initial_cost);
  EXPECT_LT(rmse(r), 0.02);
  EXPECT_LT(rmse(r), before);
  const DenseSystem system(r.nodes);
  // What is left to go is nothing against the uncertainty.
  for (std::size_t k = 0; k < r.nodes.size(); ++k) {
    const StateVector b = system.b.segment<kDim>(static_cast<Eigen::Index>(k) * kDim);
    const StateMatrix& covariance = summary.covariances[k];
    EXPECT_LT(b.dot(covariance * b), 1e-6) << k;
  }
}

TEST(BatchSmoother, CovariancesAreThoseOfTheDenseInverse) {
  Recording r = record(2, 25, 3);
  const BatchSummary summary = smoothBatch(r.nodes, SmootherSettings());
  const DenseSystem system(r.nodes);
  const Eigen::VectorXd scale = system.hessian.diagonal().cwiseSqrt().cwiseInverse();
  const Eigen::MatrixXd scaled = scale.asDiagonal() * system.hessian * scale.asDiagonal();
  const Eigen::MatrixXd inverse = scale.asDiagonal() * scaled.inverse() * scale.asDiagonal();
  for (std::size_t k = 0; k < r.nodes.size(); ++k) {
    const auto o = static_cast<Eigen::Index>(k) * kDim;
    const StateMatrix expected = inverse.block<kDim, kDim>(o, o);
    EXPECT_LT((summary.covariances[k] - expected).norm(), 1e-6 * expected.norm()) << k;
  }
}

TEST(BatchSmoother, ErrorsAreAsLargeAsTheCovarianceSays) {
  double nees = 0;
  int terms = 0;
  for (unsigned seed = 10; seed < 20; ++seed) {
    Recording r = record(seed, 100, 2);
    const BatchSummary summary = smoothBatch(r.nodes, SmootherSettings());
    for (std::size_t k = 10; k < 100; k += 10) {
      const Vec6 error = boxminus(r.nodes[k].state.T_map_body, r.truth[k].T_map_body);
      const Eigen::Matrix<double, 6, 6> covariance = summary.covariances[k].topLeftCorner<6, 6>();
      nees += error.dot(covariance.inverse() * error);
      terms += 6;
    }
  }
  EXPECT_NEAR(nees / terms, 1, 0.2);
}

TEST(BatchSmoother, RobustKernelsKeepOutliersOut) {
  const RobustKernel cauchy{RobustKernel::Kind::kCauchy, 2.0};
  Recording robust = record(3, 200, 1, cauchy);
  EXPECT_EQ(smoothBatch(robust.nodes, SmootherSettings()).status, Status::kConverged);
  Recording trusting = record(3, 200, 1, {RobustKernel::Kind::kHuber, 1e9});  // in effect none
  smoothBatch(trusting.nodes, SmootherSettings());
  EXPECT_GT(rmse(trusting), 5 * rmse(robust));
  EXPECT_LT(rmse(robust), 0.03);
}

TEST(BatchSmoother, ComesBackFromABadFirstGuess) {
  Recording good = record(4, 100, 1), bad = good;
  RandomStates random(5);
  for (ChainNode& node : bad.nodes) {
    Vec6 error;
    error << random.vector(1), random.vector(0.2);
    node.state.T_map_body = boxplus(node.state.T_map_body, error);
  }
  smoothBatch(good.nodes, SmootherSettings());
  EXPECT_EQ(smoothBatch(bad.nodes, SmootherSettings()).status, Status::kConverged);
  for (std::size_t k = 0; k < good.nodes.size(); ++k) {
    const StateVector difference = boxminus(bad.nodes[k].state, good.nodes[k].state);
    EXPECT_LT(difference.cwiseAbs().maxCoeff(), 1e-4) << k;
  }
}

TEST(BatchSmoother, SaysWhenItCannot) {
  std::vector<ChainNode> none;
  EXPECT_EQ(smoothBatch(none, SmootherSettings()).status, Status::kFailed);
  Recording r = record(6, 10, 1);
  for (ChainNode& node : r.nodes) node.node_factors.clear();
  const State before = r.nodes[5].state;
  EXPECT_EQ(smoothBatch(r.nodes, SmootherSettings()).status, Status::kFailed) << "nothing holds it";
  EXPECT_TRUE(r.nodes[5].state.T_map_body.position.allFinite());
  EXPECT_LT(boxminus(before, r.nodes[5].state).norm(), 1e3);
}

}  // namespace
}  // namespace paloc

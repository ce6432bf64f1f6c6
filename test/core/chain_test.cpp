#include "paloc/core/chain.h"

#include <gtest/gtest.h>

#include <limits>

#include "simulated_chain.h"

namespace paloc {
namespace {

// A node with one factor of every kind, robust where it can be, and the node before it.
std::pair<ChainNode, ChainNode> fullEdge(unsigned seed, RobustKernel kernel) {
  SimulatedChain chain(seed);
  ChainNode before = chain.first();
  ChainNode node = chain.next(before.state);
  const Pose motion = before.state.T_map_body.inverse() * node.state.T_map_body;
  node.edge_factors.push_back(chain.odometry());
  node.edge_factors.push_back(LidarOdometryFactor(motion, 1e-3 * Mat6::Identity(), kernel));
  node.edge_factors.push_back(NoMotionFactor(0.01, 0.01, kernel));
  node.edge_factors.push_back(VelocityFactor(SimulatedChain::kDt_s, 0.5));
  node.node_factors.push_back(chain.map(chain.truth));
  node.node_factors.push_back(MapFactor(chain.random.pose(), 10 * Mat6::Identity(), kernel));
  node.node_factors.push_back(ZeroVelocityFactor(0.1, kernel));
  node.node_factors.push_back(GravityFactor(Vec3(0.1, 0.2, 9.8), 0.01, 0.01, kernel));
  node.node_factors.push_back(
      PriorFactor::fromSigmas(chain.random.state(), StateVector::Constant(0.7)));
  before.state = chain.random.near(before.state, 0.01);
  node.state = chain.random.near(node.state, 0.01);
  return {before, node};
}

TEST(Chain, NormalEquationsHoldTheGradientOfTheRobustCost) {
  for (const auto kind :
       {RobustKernel::Kind::kNone, RobustKernel::Kind::kHuber, RobustKernel::Kind::kCauchy}) {
    for (unsigned seed = 1; seed < 30; ++seed) {
      auto [before, node] = fullEdge(seed, {kind, 1.5});
      const ChainBlock block = linearize(&before, node);
      for (ChainNode* moved : {&before, &node}) {
        const State here = moved->state;
        const StateVector& b = moved == &before ? block.b_i : block.b_j;
        for (int k = 0; k < tangent::kDim; ++k) {
          constexpr double kStep = 1e-6;
          moved->state = boxplus(here, kStep * StateVector::Unit(k));
          const double ahead = linearize(&before, node).cost;
          moved->state = boxplus(here, -kStep * StateVector::Unit(k));
          const double slope = (ahead - linearize(&before, node).cost) / (2 * kStep);
          ASSERT_NEAR(b[k], -0.5 * slope, 1e-5 * b.norm()) << "seed " << seed << " entry " << k;
        }
        moved->state = here;
      }
    }
  }
}

TEST(Chain, EdgeAndNodeShareOneBlock) {
  const auto [before, node] = fullEdge(1, {});
  const ChainBlock all = linearize(&before, node), alone = linearize(nullptr, node);
  const ChainBlock edge = linearizeEdge(before, node);
  EXPECT_LT((all.hessian_jj - alone.hessian_jj - edge.hessian_jj).norm(),
            1e-12 * all.hessian_jj.norm());
  EXPECT_LT((all.b_j - alone.b_j - edge.b_j).norm(), 1e-12 * all.b_j.norm());
  EXPECT_EQ(all.hessian_ji, edge.hessian_ji);
  EXPECT_EQ(all.hessian_ii, edge.hessian_ii);
  EXPECT_TRUE(alone.hessian_ji.isZero(0));
  EXPECT_LT((all.hessian_jj - all.hessian_jj.transpose()).norm(), 1e-12 * all.hessian_jj.norm());
}

TEST(Chain, TellsUnusableBlocks) {
  auto [before, node] = fullEdge(1, {});
  EXPECT_TRUE(linearize(&before, node).usable());
  ChainNode sure = node;
  sure.node_factors.push_back(MapFactor(Pose(), 1e30 * Mat6::Identity()));
  EXPECT_FALSE(linearize(&before, sure).usable());
  node.state.v_map.x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(linearize(&before, node).usable());
}

}  // namespace
}  // namespace paloc

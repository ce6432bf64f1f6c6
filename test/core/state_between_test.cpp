#include "paloc/core/state_between.h"

#include <gtest/gtest.h>

#include "paloc/core/batch_smoother.h"
#include "paloc/core/imu_buffer.h"
#include "smooth_motion.h"

namespace paloc {
namespace {

class StateBetweenTest : public ::testing::Test {
 protected:
  StateBetweenTest() {
    for (int k = 0; k < 900; ++k) imu_.add(motion_.imu(0.005 * k));
  }

  std::vector<EdgeFactor> edge(double from_s, double to_s) const {
    const auto p = imu_.integrate(nsFromSeconds(from_s), nsFromSeconds(to_s), 0.02, ImuNoise(),
                                  Vec3::Zero(), Vec3::Zero());
    return {ImuFactor(*p, motion_.gravity_mps2), BiasWalkFactor(ImuNoise(), to_s - from_s),
            ConstantGravityFactor(1e-6, to_s - from_s)};
  }

  // A node at the truth, with a map factor or without, and its edge from `from_s`.
  ChainNode node(double t_s, double from_s, bool with_map) const {
    ChainNode result;
    result.t_ns = nsFromSeconds(t_s);
    result.state = motion_.state(t_s);
    if (with_map) {
      result.node_factors.push_back(MapFactor(result.state.T_map_body, 2500 * Mat6::Identity()));
    }
    if (t_s > 0.05) {
      result.edge_factors = edge(from_s, t_s);
    } else {
      StateVector sigma = StateVector::Constant(0.1);
      sigma.tail<3>().setConstant(1e-3);
      result.node_factors.push_back(PriorFactor::fromSigmas(result.state, sigma));
    }
    return result;
  }

  test::SmoothMotion motion_;
  ImuBuffer imu_;
};

TEST_F(StateBetweenTest, HasTheCovarianceThatANodeThereWouldHaveHad) {
  constexpr double kGapFrom_s = 1.0, kGapTo_s = 2.0;
  for (const double asked_s : {1.004, 1.1, 1.5, 1.9}) {
    std::vector<ChainNode> without, with;
    for (int k = 0; k <= 30; ++k) {
      const double t = 0.1 * k;
      if (t > kGapFrom_s + 0.05 && t < kGapTo_s - 0.05) continue;
      const bool after_gap = std::abs(t - kGapTo_s) < 0.05;
      without.push_back(node(t, after_gap ? kGapFrom_s : t - 0.1, true));
      if (after_gap) with.push_back(node(asked_s, kGapFrom_s, false));
      with.push_back(node(t, after_gap ? asked_s : t - 0.1, true));
    }
    const BatchSummary a = smoothBatch(without, SmootherSettings());
    const BatchSummary b = smoothBatch(with, SmootherSettings());
    const std::size_t before = 10;
    const StateBetween between = conditionOnNeighbours(
        without[before].state, edge(kGapFrom_s, asked_s), with[before + 1].state,
        edge(asked_s, kGapTo_s), without[before + 1].state);
    const StateMatrix got = between.covariance(
        a.covariances[before], a.covariances_with_next[before], a.covariances[before + 1]);
    const StateMatrix& expected = b.covariances[before + 1];
    const StateVector sigma = expected.diagonal().cwiseSqrt();
    const StateMatrix difference =
        sigma.cwiseInverse().asDiagonal() * (got - expected) * sigma.cwiseInverse().asDiagonal();
    EXPECT_LT(difference.cwiseAbs().maxCoeff(), 0.02) << asked_s;
  }
}

}  // namespace
}  // namespace paloc

// Nodes that come late, but within the lag, are put into their place.

#include <gtest/gtest.h>

#include "paloc/core/fixed_lag_smoother.h"
#include "paloc/core/imu_buffer.h"
#include "smooth_motion.h"

namespace paloc {
namespace {

constexpr double kNode_s = 0.1;

class LateNodes : public ::testing::Test {
 protected:
  LateNodes() {
    for (int k = 0; k < 900; ++k) imu_.add(motion_.imu(0.005 * k));
    settings_.lag_s = 2.0;
    // One linearization each, at the truth, so that the order of arrival makes no difference.
    settings_.relinearize_position_m = settings_.relinearize_rotation_rad = 1e3;
    settings_.relinearize_velocity_mps = settings_.relinearize_bias_acc_mps2 = 1e3;
    settings_.relinearize_bias_gyro_radps = settings_.relinearize_gravity = 1e3;
  }

  std::vector<EdgeFactor> edge(int from, int to) const {
    const double dt_s = (to - from) * kNode_s;
    const auto p = imu_.integrate(nsFromSeconds(from * kNode_s), nsFromSeconds(to * kNode_s), 0.02,
                                  ImuNoise(), Vec3::Zero(), Vec3::Zero());
    return {ImuFactor(*p, motion_.gravity_mps2), BiasWalkFactor(ImuNoise(), dt_s),
            ConstantGravityFactor(1e-6, dt_s)};
  }

  // Node k with a map pose that is off by a known amount, and its edge from node `from`.
  ChainNode node(int k, int from) const {
    ChainNode result;
    result.t_ns = nsFromSeconds(k * kNode_s);
    result.state = motion_.state(k * kNode_s);
    Vec6 error;
    error << 0.01 * std::sin(k), 0.01 * std::cos(k), 0.005, 0.002 * std::sin(2 * k), 0, 0.001;
    result.node_factors.push_back(
        MapFactor(boxplus(result.state.T_map_body, error), 1e4 * Mat6::Identity()));
    if (k == 0) {
      StateVector sigma = StateVector::Constant(0.1);
      sigma.tail<3>().setConstant(1e-3);
      result.node_factors.push_back(PriorFactor::fromSigmas(result.state, sigma));
    } else {
      result.edge_factors = edge(from, k);
    }
    return result;
  }

  test::SmoothMotion motion_;
  ImuBuffer imu_;
  SmootherSettings settings_;
};

TEST_F(LateNodes, GiveTheSameResultAsNodesInOrder) {
  FixedLagSmoother in_order(settings_), late(settings_);
  for (int k = 0; k < 40; ++k) in_order.add(node(k, k - 1));
  // Every fifth node comes three nodes late: the one after it is joined to the one before
  // meanwhile.
  for (int k = 0; k < 40; ++k) {
    const auto missing = [](int n) { return n % 5 == 3; };
    if (!missing(k)) late.add(node(k, missing(k - 1) ? k - 2 : k - 1));
    if (k >= 6 && missing(k - 3)) {
      ASSERT_EQ(late.insert(node(k - 3, k - 4), edge(k - 3, k - 2)).status,
                UpdateSummary::Status::kGood);
    }
  }
  late.insert(node(38, 37), edge(38, 39));
  const auto expected = in_order.window(true), got = late.window(true);
  ASSERT_EQ(expected.size(), got.size());
  for (std::size_t k = 0; k < got.size(); ++k) {
    EXPECT_EQ(expected[k].t_ns, got[k].t_ns);
    EXPECT_LT(boxminus(expected[k].state, got[k].state).norm(), 1e-9) << k;
    EXPECT_LT((expected[k].covariance - got[k].covariance).norm(),
              1e-9 * expected[k].covariance.norm())
        << k;
  }
}

TEST_F(LateNodes, AreRefusedWhereTheirPlaceHasGoneOrIsTaken) {
  FixedLagSmoother smoother(settings_);
  for (int k = 0; k < 40; k += 2) smoother.add(node(k, k - 2));
  EXPECT_EQ(smoother.insert(node(3, 2), edge(3, 4)).status, UpdateSummary::Status::kRefused);
  EXPECT_EQ(smoother.addFactor(1, ZeroVelocityFactor(0.1)).status, UpdateSummary::Status::kRefused);
  EXPECT_EQ(smoother.refusedAsTooOld(), 2u);
  EXPECT_EQ(smoother.insert(node(36, 34), edge(36, 38)).status, UpdateSummary::Status::kRefused)
      << "taken";
  EXPECT_EQ(smoother.insert(node(39, 38), {}).status, UpdateSummary::Status::kRefused)
      << "not late at all";
  EXPECT_EQ(smoother.refusedAsTooOld(), 2u);
  EXPECT_EQ(smoother.insert(node(35, 34), edge(35, 36)).status, UpdateSummary::Status::kGood);
}

}  // namespace
}  // namespace paloc

#include "paloc/core/no_motion_factor.h"

#include <gtest/gtest.h>

#include "factor_jacobian_check.h"
#include "random_states.h"

namespace paloc {
namespace {

TEST(NoMotionFactor, Jacobians) {
  RandomStates random(1);
  for (int trial = 0; trial < 1000 && !testing::Test::HasFatalFailure(); ++trial) {
    const NoMotionFactor factor(random.uniform(1e-3, 1), random.uniform(1e-3, 1));
    const State i = random.state();
    expectJacobiansMatchDifferences(factor, i, random.relatedTo(i, trial));
  }
}

TEST(NoMotionFactor, IsZeroAtRestAndWhitenedOtherwise) {
  RandomStates random(2);
  const State i = random.state();
  const NoMotionFactor factor(0.002, 0.0005);
  State j = random.state();
  j.T_map_body = i.T_map_body;
  EXPECT_LT(factor.linearize(i, j).residual.norm(), 1e-9);
  // 2 mm ahead and 1 mrad of yaw, seen from i.
  j.T_map_body = i.T_map_body * Pose{Vec3(0.002, 0, 0), so3::exp(Vec3(0, 0, 0.001))};
  Eigen::Matrix<double, 6, 1> expected;
  expected << 1, 0, 0, 0, 0, 2;
  EXPECT_LT((factor.linearize(i, j).residual - expected).norm(), 1e-8);
}

}  // namespace
}  // namespace paloc

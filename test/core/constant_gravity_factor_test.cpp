#include "paloc/core/constant_gravity_factor.h"

#include <gtest/gtest.h>

#include "factor_jacobian_check.h"
#include "random_states.h"

namespace paloc {
namespace {

TEST(ConstantGravityFactor, Jacobians) {
  RandomStates random(1);
  for (int trial = 0; trial < 1000 && !testing::Test::HasFatalFailure(); ++trial) {
    const State i = random.state();
    const ConstantGravityFactor factor(random.uniform(1e-6, 1e-3), random.uniform(0.01, 10));
    expectJacobiansMatchDifferences(factor, i, random.relatedTo(i, trial));
  }
}

TEST(ConstantGravityFactor, GrowsWithTheRootOfTime) {
  State i, j;
  j.gravity_map += Vec3(1e-5, 0, -3e-5);
  const Vec3 expected(0.5, 0, -1.5);  // after 4 s sigma is 2e-5
  EXPECT_LT((ConstantGravityFactor(1e-5, 4).linearize(i, j).residual - expected).norm(), 1e-9);
}

}  // namespace
}  // namespace paloc

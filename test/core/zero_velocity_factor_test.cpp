#include "paloc/core/zero_velocity_factor.h"

#include <gtest/gtest.h>

#include "factor_jacobian_check.h"
#include "random_states.h"

namespace paloc {
namespace {

TEST(ZeroVelocityFactor, Jacobians) {
  RandomStates random(1);
  for (int trial = 0; trial < 1000 && !testing::Test::HasFatalFailure(); ++trial) {
    expectJacobiansMatchDifferences(ZeroVelocityFactor(random.uniform(1e-3, 1)), random.state());
  }
}

TEST(ZeroVelocityFactor, ResidualIsTheVelocityInSigmas) {
  State x;
  x.v_map = Vec3(0.01, -0.02, 0.03);
  EXPECT_LT((ZeroVelocityFactor(0.01).linearize(x).residual - Vec3(1, -2, 3)).norm(), 1e-12);
}

}  // namespace
}  // namespace paloc

#include "paloc/core/velocity_factor.h"

#include <gtest/gtest.h>

#include "factor_jacobian_check.h"
#include "random_states.h"

namespace paloc {
namespace {

TEST(VelocityFactor, Jacobians) {
  RandomStates random(1);
  for (int trial = 0; trial < 1000 && !testing::Test::HasFatalFailure(); ++trial) {
    const State i = random.state();
    const VelocityFactor factor(random.uniform(0.01, 2), random.uniform(0.01, 1));
    expectJacobiansMatchDifferences(factor, i, random.relatedTo(i, trial));
  }
}

TEST(VelocityFactor, IsZeroUnderConstantAccelerationAndWhitenedOtherwise) {
  constexpr double kDt_s = 0.2;
  const Vec3 acceleration(1, -2, 0.5);
  State i, j;
  i.v_map = Vec3(3, 0, 0);
  j.T_map_body.position = i.v_map * kDt_s + 0.5 * kDt_s * kDt_s * acceleration;
  j.v_map = i.v_map + acceleration * kDt_s;
  EXPECT_LT(VelocityFactor(kDt_s, 0.1).linearize(i, j).residual.norm(), 1e-12);
  j.v_map.x() += 0.4;  // half of it counts, in sigmas of 0.1 m/s
  EXPECT_LT((VelocityFactor(kDt_s, 0.1).linearize(i, j).residual + 2 * Vec3::UnitX()).norm(),
            1e-12);
}

}  // namespace
}  // namespace paloc

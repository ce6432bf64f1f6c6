#include "paloc/core/bias_walk_factor.h"

#include <gtest/gtest.h>

#include "factor_jacobian_check.h"
#include "random_states.h"

namespace paloc {
namespace {

TEST(BiasWalkFactor, Jacobians) {
  RandomStates random(1);
  for (int trial = 0; trial < 1000 && !testing::Test::HasFatalFailure(); ++trial) {
    const State i = random.state();
    const BiasWalkFactor factor(ImuNoise(), random.uniform(0.01, 10));
    expectJacobiansMatchDifferences(factor, i, random.relatedTo(i, trial));
  }
}

TEST(BiasWalkFactor, GrowsWithTheRootOfTime) {
  ImuNoise noise;
  noise.accelerometer_bias_walk_mps3_sqrthz = 1e-3;
  noise.gyroscope_bias_walk_radps2_sqrthz = 1e-4;
  State i, j;
  j.bias_acc = Vec3(2e-3, 0, 0);
  j.bias_gyro = Vec3(0, 4e-4, 0);
  Eigen::Matrix<double, 6, 1> expected;  // after 4 s sigmas are 2e-3 and 2e-4
  expected << 1, 0, 0, 0, 2, 0;
  EXPECT_LT((BiasWalkFactor(noise, 4).linearize(i, j).residual - expected).norm(), 1e-12);
}

}  // namespace
}  // namespace paloc

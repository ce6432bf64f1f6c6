#include "paloc/core/gravity_factor.h"

#include <gtest/gtest.h>

#include "factor_jacobian_check.h"
#include "random_states.h"

namespace paloc {
namespace {

TEST(GravityFactor, Jacobians) {
  RandomStates random(1);
  for (int trial = 0; trial < 1000 && !testing::Test::HasFatalFailure(); ++trial) {
    const State x = random.state();
    // Half of them near the truth, as at rest; the others anywhere.
    const Vec3 up_body = x.T_map_body.rotation.transpose() * Vec3::UnitZ();
    const Vec3 force = trial % 2 == 0 ? Vec3(9.81 * up_body + random.vector(0.05))
                                      : Vec3(9.81 * random.direction());
    expectJacobiansMatchDifferences(
        GravityFactor(force, random.uniform(1e-3, 0.1), random.uniform(1e-3, 0.1)), x);
  }
}

TEST(GravityFactor, IsZeroForALevelPlatformAtRest) {
  State x;
  x.bias_acc = Vec3(0.1, 0, 0);
  const GravityFactor factor(Vec3(0.1, 0, 9.81), 0.01, 0.001);
  EXPECT_LT(factor.linearize(x).residual.norm(), 1e-12);
}

TEST(GravityFactor, TellsTiltAndLengthInSigmas) {
  State x;
  x.T_map_body.rotation = so3::exp(Vec3(0.02, 0, 0));  // roll: up in the body leans to -y
  x.gravity_map = Vec3(0, 0, -1.002);
  const auto l = GravityFactor(Vec3(0, 0, 9.7), 0.01, 0.001).linearize(x);
  const Eigen::Vector4d expected(0, -std::sin(0.02) / 0.01, (std::cos(0.02) - 1.002) / 0.01, 2);
  EXPECT_LT((l.residual - expected).norm(), 1e-9);
}

TEST(GravityFactor, ATiltedMapShowsInTheDirectionOfGravity) {
  // Body and map agree, but both lean by 1 degree: gravity in the map leans the other way.
  State x;
  const Mat3 lean = so3::exp(Vec3(0, 0.017, 0));
  x.gravity_map = lean * -Vec3::UnitZ();
  EXPECT_LT(GravityFactor(lean * Vec3(0, 0, 9.81), 0.01, 0.001).linearize(x).residual.norm(),
            1e-12);
}

}  // namespace
}  // namespace paloc

#include "paloc/frontends/lio_state.h"

#include <gtest/gtest.h>

#include <random>

namespace paloc {
namespace {

LioState randomState(std::mt19937_64& random) {
  std::normal_distribution<double> normal;
  const auto vector = [&] { return Vec3(normal(random), normal(random), normal(random)); };
  LioState x;
  x.T_odom_body = {10 * vector(), so3::exp(vector())};
  x.v_odom = vector();
  x.bias_acc = 0.1 * vector();
  x.bias_gyro = 0.01 * vector();
  x.gravity_odom = so3::exp(0.4 * vector()) * x.gravity_odom;
  return x;
}

TEST(LioState, BoxplusUndoesBoxminus) {
  std::mt19937_64 random(3);
  for (int i = 0; i < 1000; ++i) {
    const LioState from = randomState(random), to = randomState(random);
    const LioState back = boxplus(from, boxminus(to, from));
    EXPECT_LT((back.T_odom_body.position - to.T_odom_body.position).norm(), 1e-9);
    EXPECT_LT((back.T_odom_body.rotation - to.T_odom_body.rotation).norm(), 1e-9);
    EXPECT_LT((back.v_odom - to.v_odom).norm(), 1e-12);
    EXPECT_LT((back.bias_acc - to.bias_acc).norm(), 1e-12);
    EXPECT_LT((back.bias_gyro - to.bias_gyro).norm(), 1e-12);
    EXPECT_LT((back.gravity_odom - to.gravity_odom).norm(), 1e-9);
  }
}

TEST(LioState, GravityKeepsItsLength) {
  std::mt19937_64 random(4);
  LioVector delta = LioVector::Zero();
  delta.tail<2>() << 0.3, -0.2;
  for (int i = 0; i < 100; ++i) {
    const LioState x = randomState(random);
    EXPECT_NEAR(boxplus(x, delta).gravity_odom.norm(), 9.80665, 1e-9);
    EXPECT_NEAR(std::acos(boxplus(x, delta).gravity_odom.dot(x.gravity_odom) /
                          x.gravity_odom.squaredNorm()),
                delta.tail<2>().norm(), 1e-9);
  }
}

}  // namespace
}  // namespace paloc

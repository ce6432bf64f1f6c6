#include "paloc/core/so3.h"

#include <gtest/gtest.h>

#include <numbers>
#include <random>

#include "paloc/core/pose.h"

namespace paloc {
namespace {

Vec3 randomDirection(std::mt19937_64& rng) {
  std::normal_distribution<double> normal;
  return Vec3(normal(rng), normal(rng), normal(rng)).normalized();
}

// Angles that matter: the series, the switch to the closed form, the middle, and next to pi.
const double kAngles[] = {0,
                          1e-12,
                          1e-7,
                          0.9e-4,
                          1.1e-4,
                          1e-3,
                          0.1,
                          1.0,
                          2.0,
                          3.0,
                          std::numbers::pi - 1e-3,
                          std::numbers::pi - 1e-7};

TEST(So3, LogInvertsExp) {
  std::mt19937_64 rng(1);
  for (const double angle : kAngles) {
    for (int i = 0; i < 100; ++i) {
      const Vec3 w = angle * randomDirection(rng);
      EXPECT_LT((so3::log(so3::exp(w)) - w).norm(), 1e-9 * std::max(angle, 1e-6)) << angle;
    }
  }
}

TEST(So3, ExpIsARotation) {
  std::mt19937_64 rng(2);
  for (const double angle : kAngles) {
    const Mat3 r = so3::exp(angle * randomDirection(rng));
    EXPECT_LT((r * r.transpose() - Mat3::Identity()).norm(), 1e-14);
    EXPECT_NEAR(r.determinant(), 1, 1e-14);
  }
}

TEST(So3, RightJacobianMatchesDifferences) {
  std::mt19937_64 rng(3);
  constexpr double h = 1e-6;
  for (const double angle : kAngles) {
    const Vec3 w = angle * randomDirection(rng);
    Mat3 numeric;
    for (int i = 0; i < 3; ++i) {
      const Vec3 d = h * Vec3::Unit(i);
      numeric.col(i) = so3::log(so3::exp(w - d).transpose() * so3::exp(w + d)) / (2 * h);
    }
    EXPECT_LT((so3::rightJacobian(w) - numeric).norm(), 1e-8) << angle;
    EXPECT_LT((so3::rightJacobian(w) * so3::rightJacobianInverse(w) - Mat3::Identity()).norm(),
              1e-9)
        << angle;
  }
}

TEST(Pose, BoxminusInvertsBoxplus) {
  std::mt19937_64 rng(4);
  for (const double angle : kAngles) {
    const Pose pose{randomDirection(rng), so3::exp(randomDirection(rng))};
    Vec6 delta;
    delta << 3 * randomDirection(rng), angle * randomDirection(rng);
    EXPECT_LT((boxminus(boxplus(pose, delta), pose) - delta).norm(), 1e-8);
  }
}

TEST(Pose, InverseComposesToIdentity) {
  std::mt19937_64 rng(5);
  const Pose pose{randomDirection(rng), so3::exp(2 * randomDirection(rng))};
  const Pose identity = pose * pose.inverse();
  EXPECT_LT(identity.position.norm(), 1e-15);
  EXPECT_LT((identity.rotation - Mat3::Identity()).norm(), 1e-14);
}

}  // namespace
}  // namespace paloc

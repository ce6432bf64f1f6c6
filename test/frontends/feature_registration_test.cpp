#include "paloc/frontends/feature_registration.h"

#include <gtest/gtest.h>

#include <random>

namespace paloc {
namespace {

/// Points on planes across the given axes, at +-3 m, with 1 cm of noise, and on four poles if
/// asked; the body is at rest at the origin, in the middle of them.
struct World {
  ScanFeatures features;
  KeyFrameMap map{{}};

  explicit World(const std::vector<int>& axes, bool poles = false) {
    std::mt19937_64 random(11);
    std::normal_distribution<double> noise(0, 0.01);
    std::uniform_real_distribution<double> along(-2.9, 2.9);
    std::vector<PlacedPoint> planes, edges;
    for (int i = 0; i < 60'000; ++i) {
      const int axis = axes[static_cast<std::size_t>(i) % axes.size()];
      Vec3 p(along(random), along(random), along(random));
      p[axis] = ((i / 6) % 2 == 0 ? 3 : -3) + noise(random);
      if (i < 58'000) {
        planes.push_back({p, p, p, 0});
      } else {
        features.planes.push_back({p, 0});
      }
    }
    for (int i = 0; poles && i < 4000; ++i) {
      const Vec3 p((i % 2 == 0 ? 1.3 : -1.7) + noise(random),
                   ((i / 2) % 2 == 0 ? 1.8 : -1.2) + noise(random), along(random));
      if (i < 3700) {
        edges.push_back({p, p, p, 0});
      } else {
        features.edges.push_back({p, 0});
      }
    }
    map.add(planes, edges);
  }

  FeatureMeasurement align(const LioState& predicted, double sigma) {
    ImuBuffer imu;
    for (TimeNs t = 0; t <= kNsPerSecond; t += 5'000'000) {
      imu.add({t, Vec3(0, 0, 9.80665), Vec3::Zero()});
    }
    const FreeFallScan scan(imu, kNsPerSecond / 2, kNsPerSecond / 2, 0.05, Vec3::Zero(),
                            Vec3::Zero());
    FeatureRegistration registration({});
    return registration.align(features, scan, Vec3::Zero(), map, predicted,
                              sigma * sigma * LioMatrix::Identity());
  }
};

LioState off() {
  LioState x;
  x.T_odom_body = {Vec3(0.08, -0.06, 0.05), so3::exp(Vec3(0.01, -0.01, 0.02))};
  return x;
}

double sigmaAlong(const FeatureMeasurement& measured, int axis) {
  return 1 / std::sqrt(measured.information(axis, axis));
}

TEST(FeatureRegistration, ARoomTellsThePose) {
  const FeatureMeasurement measured = World({0, 1, 2}).align(off(), 0.2);
  EXPECT_EQ(measured.points, 2000U);
  EXPECT_GT(measured.matchedShare(), 0.7);
  EXPECT_LT(measured.found.T_odom_body.position.norm(), 0.003);
  EXPECT_LT(so3::log(measured.found.T_odom_body.rotation).norm(), 0.002);
  for (int axis = 0; axis < 6; ++axis) {
    EXPECT_LT(sigmaAlong(measured, axis), 0.002) << axis;
    EXPECT_GT(sigmaAlong(measured, axis), 1e-5) << axis;
  }
}

TEST(FeatureRegistration, PolesTellWhatTheFloorLeavesOpen) {
  const FeatureMeasurement floor = World({2}).align(off(), 0.2);
  EXPECT_LT(floor.information(0, 0), 1e-3 * floor.information(2, 2));
  EXPECT_LT((floor.found.T_odom_body.position - off().T_odom_body.position).head<2>().norm(), 0.02)
      << "left where it was predicted";
  const FeatureMeasurement measured = World({2}, true).align(off(), 0.2);
  EXPECT_LT(measured.found.T_odom_body.position.norm(), 0.005);
  EXPECT_LT(so3::log(measured.found.T_odom_body.rotation).norm(), 0.003);
  for (int axis = 0; axis < 6; ++axis) EXPECT_LT(sigmaAlong(measured, axis), 0.005) << axis;
}

TEST(FeatureRegistration, AlongABareCorridorNothingIsKnown) {
  const FeatureMeasurement measured = World({1, 2}).align(off(), 0.2);
  EXPECT_LT(measured.information(0, 0), 1e-6 * measured.information(1, 1));
  EXPECT_NEAR(measured.found.T_odom_body.position.x(), off().T_odom_body.position.x(), 0.01);
  EXPECT_LT(measured.found.T_odom_body.position.tail<2>().norm(), 0.003);
}

TEST(FeatureRegistration, TooFewMatchesSayNothing) {
  World world({0, 1, 2});
  world.map.clear();
  const FeatureMeasurement measured = world.align(off(), 0.2);
  EXPECT_EQ(measured.matched, 0U);
  EXPECT_TRUE(measured.information.isZero(0));
  EXPECT_TRUE(measured.gradient.isZero(0));
  EXPECT_EQ(measured.found.T_odom_body.position, off().T_odom_body.position);
}

}  // namespace
}  // namespace paloc

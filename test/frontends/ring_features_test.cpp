#include "paloc/frontends/ring_features.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <random>

namespace paloc {
namespace {

constexpr double kStep = 0.35 * std::numbers::pi / 180;

/// Distance (m) that a level beam of an azimuth (rad) goes; 0 for no return.
using RangeAt = std::function<double(double)>;

/// A scan of `rings` level rings of 20 cm distance in a world of upright walls, over +-60 degrees.
LidarFrame scanOf(const RangeAt& range_at, double noise_m = 0, std::uint16_t rings = 1) {
  std::mt19937_64 random(5);
  std::normal_distribution<double> noise(0, 1);
  LidarFrame frame;
  for (int i = -171; i <= 171; ++i) {
    const double azimuth = i * kStep;
    for (std::uint16_t ring = 0; ring < rings; ++ring) {
      double range = range_at(azimuth);
      if (range == 0) continue;
      range += noise_m * noise(random);
      frame.points_lidar.push_back({static_cast<float>(range * std::cos(azimuth)),
                                    static_cast<float>(range * std::sin(azimuth)),
                                    0.2F * static_cast<float>(ring)});
      frame.ring.push_back(ring);
    }
  }
  return frame;
}

/// A wall across the x axis, and one across y: they meet in a corner at (x, y).
RangeAt roomCorner(double x, double y) {
  return [=](double azimuth) {
    const double ahead = x / std::cos(azimuth);
    return azimuth > 0 ? std::min(ahead, y / std::sin(azimuth)) : ahead;
  };
}

double azimuthOf(const LidarFrame& frame, std::uint32_t i) {
  return std::atan2(frame.points_lidar[i].y, frame.points_lidar[i].x);
}

TEST(RingFeatures, AWallIsPlanesOnly) {
  const LidarFrame frame = scanOf([](double azimuth) { return 4 / std::cos(azimuth); }, 0.02);
  RingFeatures features({});
  features.extract(frame);
  EXPECT_TRUE(features.edges().empty());
  EXPECT_GT(features.planes().size(), frame.points_lidar.size() * 9 / 10);
}

TEST(RingFeatures, TheCornerOfARoomIsTheEdge) {
  const LidarFrame frame = scanOf(roomCorner(4, 2.5), 0.01, 8);
  RingFeatures features({});
  features.extract(frame);
  ASSERT_EQ(features.edges().size(), 8U) << "one a ring";
  for (const std::uint32_t i : features.edges()) {
    EXPECT_NEAR(frame.points_lidar[i].x, 4, 0.1);
    EXPECT_NEAR(frame.points_lidar[i].y, 2.5, 0.1);
  }
  // What lies well off the corner is plane.
  const auto away = std::count_if(
      features.planes().begin(), features.planes().end(),
      [&](std::uint32_t i) { return std::abs(azimuthOf(frame, i) - std::atan2(2.5, 4)) > 0.15; });
  EXPECT_GT(static_cast<double>(away),
            0.85 * static_cast<double>(frame.points_lidar.size()) * 0.85);
}

/// A pillar's face before a wall: it hides a part of the wall, whose ends beside it are no edges.
TEST(RingFeatures, OfAJumpTheNearSideIsTheEdgeAndTheFarSideIsNone) {
  const LidarFrame frame = scanOf(
      [](double azimuth) { return (std::abs(azimuth) < 0.1 ? 2 : 5) / std::cos(azimuth); }, 0.005);
  RingFeatures features({});
  features.extract(frame);
  ASSERT_EQ(features.edges().size(), 2U);
  for (const std::uint32_t i : features.edges()) {
    EXPECT_NEAR(frame.points_lidar[i].x, 2, 0.05) << "on the pillar";
    EXPECT_NEAR(std::abs(azimuthOf(frame, i)), 0.1, 2 * kStep);
  }
}

TEST(RingFeatures, AGapBetweenReturnsIsNoEdge) {
  const LidarFrame frame =
      scanOf([](double azimuth) { return std::abs(azimuth) < 0.1 ? 0 : 4 / std::cos(azimuth); });
  RingFeatures features({});
  features.extract(frame);
  EXPECT_TRUE(features.edges().empty());
}

/// A wall that the beams graze, 0.3 m beside the sensor.
TEST(RingFeatures, WhereTheBeamRunsAlongTheSurfaceNothingIsAFeature) {
  const LidarFrame frame = scanOf([](double azimuth) {
    const double far = azimuth > 0.02 && azimuth < 0.24 ? 0.3 / std::sin(azimuth) : 0;
    return far;
  });
  ASSERT_GT(frame.points_lidar.size(), 20U);
  RingFeatures features({});
  features.extract(frame);
  EXPECT_TRUE(features.edges().empty());
  EXPECT_TRUE(features.planes().empty());
}

TEST(RingFeatures, EdgesAreSharedOutAmongTheSectors) {
  // A fence: boards of half a metre, turn about at 3 and 3.4 m.
  const LidarFrame frame = scanOf([](double azimuth) {
    const double y = 3 * std::tan(azimuth);
    return (std::fmod(y + 100, 1.0) < 0.5 ? 3 : 3.4) / std::cos(azimuth);
  });
  RingFeatureLimits limits;
  limits.edges_per_sector = 1;
  RingFeatures features(limits);
  features.extract(frame);
  EXPECT_EQ(features.edges().size(), 6U);
  limits.edges_per_sector = 2;
  RingFeatures more(limits);
  more.extract(frame);
  EXPECT_GT(more.edges().size(), 8U);
  limits.edges_per_sector = 0;
  RingFeatures none(limits);
  none.extract(frame);
  EXPECT_TRUE(none.edges().empty());
}

TEST(RingFeatures, ScansOfNearlyNothingAreTaken) {
  RingFeatures features({});
  features.extract({});
  EXPECT_TRUE(features.planes().empty());
  LidarFrame one;
  one.points_lidar = {{1, 0, 0}};
  one.ring = {65535};
  features.extract(one);
  EXPECT_TRUE(features.planes().empty());
  EXPECT_TRUE(features.edges().empty());
}

}  // namespace
}  // namespace paloc

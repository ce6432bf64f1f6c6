#include "paloc/frontends/key_frame_map.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

namespace paloc {
namespace {

/// Points of a floor 1 m under a sensor, around it.
std::vector<PlacedPoint> floorUnder(const Vec3& sensor, double height_m = -1) {
  std::mt19937_64 random(9);
  std::uniform_real_distribution<double> along(-1, 1);
  std::vector<PlacedPoint> points;
  for (int i = 0; i < 2000; ++i) {
    const Vec3 ray(along(random), along(random), height_m);
    points.push_back({sensor + ray, ray, ray, 0});
  }
  return points;
}

std::vector<PlacedPoint> poleBeside(const Vec3& sensor) {
  std::vector<PlacedPoint> points;
  for (int i = 0; i < 20; ++i) {
    const Vec3 ray(0.6, 0.6, -0.9 + 0.02 * i);
    points.push_back({sensor + ray, ray, ray, 0});
  }
  return points;
}

TEST(KeyFrameMap, KnowsThePlanesAndLinesOfItsKeyFrames) {
  KeyFrameMap map({});
  const Vec3 sensor(7.3, 2.1, 0.4);
  map.add(floorUnder(sensor), poleBeside(sensor));
  LocalPlane plane;
  ASSERT_TRUE(map.planes().find(sensor - Vec3::UnitZ(), -Vec3::UnitZ(), plane));
  EXPECT_GT(plane.normal.z(), 0.999);
  EXPECT_NEAR(plane.centroid.z(), -0.6, 1e-4);
  LocalLine line;
  ASSERT_TRUE(map.lines().find(sensor + Vec3(0.6, 0.6, -0.7), line));
  EXPECT_GT(std::abs(line.direction.z()), 0.999);
  map.clear();
  EXPECT_EQ(map.keyFrames(), 0U);
  EXPECT_FALSE(map.planes().find(sensor - Vec3::UnitZ(), -Vec3::UnitZ(), plane));
}

TEST(KeyFrameMap, TheFirstKeyFrameCanBePlacedAnew) {
  KeyFrameMap map({});
  const Vec3 sensor(0.1, 0.1, 1.1);
  map.add(floorUnder(sensor), {});
  map.replaceFirst(floorUnder(sensor, -1.05), {});
  EXPECT_EQ(map.keyFrames(), 1U);
  LocalPlane plane;
  ASSERT_TRUE(map.planes().find(sensor - Vec3(0, 0, 1.05), -Vec3::UnitZ(), plane));
  EXPECT_NEAR(plane.centroid.z(), 0.05, 1e-4);
}

TEST(KeyFrameMap, OnceForgottenTheFirstKeyFrameStaysForgotten) {
  KeyFrameLimits limits;
  limits.max_key_frames = 4;
  KeyFrameMap map(limits);
  for (int i = 0; i < 5; ++i) map.add(floorUnder(Vec3(0.1 + 10 * i, 0.1, 1.1)), {});
  map.replaceFirst(floorUnder(Vec3(0.1, 0.1, 1.1)), {});
  LocalPlane plane;
  EXPECT_FALSE(map.planes().find(Vec3(0.1, 0.1, 0.1), -Vec3::UnitZ(), plane));
  EXPECT_TRUE(map.planes().find(Vec3(20.1, 0.1, 0.1), -Vec3::UnitZ(), plane)) << "the oldest left";
}

// What is left is known all the while, and as well as before.
TEST(KeyFrameMap, ForgettingLeavesThePlanesOfTheOthersAsTheyAre) {
  KeyFrameLimits limits;
  limits.max_key_frames = 8;
  KeyFrameMap map(limits);
  const auto sensorOf = [](int i) { return Vec3(10.0 * i + 0.1, 0.1, 1.1); };
  for (int i = 0; i < 30; ++i) {
    map.add(floorUnder(sensorOf(i)), {});
    EXPECT_GE(map.keyFrames(), std::min<std::size_t>(static_cast<std::size_t>(i) + 1, 6)) << i;
    KeyFrameMap alone(limits);
    for (int k = std::max(i - 5, 0); k <= i; ++k) {
      alone.clear();
      alone.add(floorUnder(sensorOf(k)), {});
      LocalPlane plane, expected;
      const Vec3 below = sensorOf(k) - Vec3::UnitZ();
      ASSERT_TRUE(alone.planes().find(below, -Vec3::UnitZ(), expected));
      ASSERT_TRUE(map.planes().find(below, -Vec3::UnitZ(), plane)) << i << " " << k;
      EXPECT_EQ(plane.points, expected.points) << "each key frame counts once";
      EXPECT_EQ(plane.centroid, expected.centroid);
    }
  }
}

// One that makes room costs no more than a few others.
TEST(KeyFrameMap, NoKeyFramePaysForAllThatAreLeft) {
  KeyFrameMap map({});
  const auto floor = floorUnder(Vec3(0.1, 0.1, 1.1));
  std::size_t most = 0;
  for (int i = 0; i < 200; ++i) {
    map.add(floor, {});
    most = std::max(most, map.filled());
  }
  EXPECT_GT(map.keyFrames(), 40U);
  EXPECT_LE(most, 4U);
}

TEST(KeyFrameMap, ForgetsWhatIsFarAndThenWhatIsOldSoThatMemoryIsBounded) {
  KeyFrameLimits limits;
  limits.max_key_frames = 8;
  limits.max_distance_m = 30;
  KeyFrameMap map(limits);
  std::size_t most_bytes = 0;
  for (int i = 0; i < 60; ++i) {
    map.add(floorUnder(Vec3(2.0 * i, 0, 0)), {});
    EXPECT_LE(map.keyFrames(), 8U);
    if (i == 20) most_bytes = map.bytes();
    if (i > 20) {
      EXPECT_LE(map.bytes(), 2 * most_bytes) << i;
    }
  }
  LocalPlane plane;
  EXPECT_TRUE(map.planes().find(Vec3(118, 0, -1), -Vec3::UnitZ(), plane)) << "the last";
  EXPECT_FALSE(map.planes().find(Vec3(0, 0, -1), -Vec3::UnitZ(), plane)) << "the first";
  map.add(floorUnder(Vec3(500, 0, 0)), {});
  while (map.keyFrames() < 8) map.add(floorUnder(Vec3(500, 0, 0)), {});
  map.add(floorUnder(Vec3(500, 0, 0)), {});
  EXPECT_FALSE(map.planes().find(Vec3(118, 0, -1), -Vec3::UnitZ(), plane)) << "far away";
}

}  // namespace
}  // namespace paloc

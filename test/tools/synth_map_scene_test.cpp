#include "paloc/tools/synth_map_scene.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "octree_room.h"
#include "paloc/core/errors.h"
#include "paloc/tools/free_level.h"
#include "paloc/tools/synth_raycaster.h"
#include "paloc/tools/synth_walk.h"
#include "temp_dir.h"

namespace paloc::synth {
namespace {

constexpr double kLength = 12, kWidth = 4, kHeight = 3;

OctreeMap room(double cell_m) {
  const test::TempDir folder;
  test::writeRoom(folder / "room.bt", cell_m, kLength, kWidth, kHeight);
  return OctreeMap::load(folder / "room.bt");
}

TEST(SynthMapScene, SurfacesAreClosedAndHalfACellBehindTheFaces) {
  constexpr double kCell = 0.2;
  const SceneMesh mesh = meshOf(room(kCell));
  ASSERT_EQ(mesh.triangles.size(), mesh.triangle_surface.size());
  const Raycaster raycaster(mesh);
  const Vec3 origin(3.3, 1.7, 1.2);
  std::mt19937 random(1);
  std::normal_distribution<float> normal;
  std::vector<Eigen::Vector3f> directions(20'000);
  for (auto& d : directions)
    d = Eigen::Vector3f(normal(random), normal(random), normal(random)).normalized();
  std::vector<RayHit> hits(directions.size());
  raycaster.cast(origin, directions, hits);
  const Vec3 low = Vec3::Constant(-kCell / 2), high = Vec3(kLength, kWidth, kHeight) - low;
  for (std::size_t i = 0; i < hits.size(); ++i) {
    ASSERT_TRUE(hits[i].valid());
    const Vec3 d = directions[i].cast<double>();
    double expected = 1e9;
    for (int axis = 0; axis < 3; ++axis) {
      expected = std::min(expected, ((d[axis] > 0 ? high : low)[axis] - origin[axis]) / d[axis]);
    }
    ASSERT_NEAR(static_cast<double>(hits[i].distance_m), expected, 1e-4);
  }
}

TEST(SynthMapScene, TheWalkKeepsHalfAMetreClear) {
  for (const double cell_m : {0.05, 0.2}) {
    const OctreeMap map = room(cell_m);
    const std::vector<Vec3> route = routeThrough(map);
    double longest = 0;
    for (const Vec3& a : route) longest = std::max(longest, (a - route.front()).norm());
    EXPECT_GT(longest, kLength - 3);
    const Motion motion = makeWalk(route, 60, 1'000'000'000, 1);
    for (int i = 0; i < 600; ++i) {
      const Vec3 p = motion.at(motion.startNs() + i * 100'000'000LL).T_map_body.position;
      const Vec3 to_high = Vec3(kLength, kWidth, kHeight) - p;
      ASSERT_GT(std::min(p.minCoeff(), to_high.minCoeff()), 0.5) << p.transpose();
      ASSERT_NEAR(p.z(), 1.35, 0.25);
    }
  }
}

TEST(SynthMapScene, RefusesAMapWithoutAWay) {
  const test::TempDir folder;
  test::writeRoom(folder / "cell.bt", 0.1, 3, 3, 3);
  EXPECT_THROW(makeMapScene(folder / "cell.bt", true), UsageError);
  EXPECT_TRUE(makeMapScene(folder / "cell.bt", false).route.empty());
  folder.write("broken.bt", "# Octomap OcTree binary file\n");
  EXPECT_THROW(makeMapScene(folder / "broken.bt", false), IoError);
}

TEST(FreeLevel, IsClearWhereNothingIsNear) {
  const OctreeMap map = room(0.1);
  const FreeLevel level(map, 14, 0.6);
  EXPECT_TRUE(level.clear({60, 20}));
  EXPECT_FALSE(level.clear({60, 4}));            // 45 cm from the wall
  EXPECT_TRUE(level.clear({60, 8}));             // 85 cm
  EXPECT_FALSE(level.clear({-20, 20}));          // outside
  EXPECT_EQ(FreeLevel(map, 3, 0.6).size(), 0U);  // 35 cm above the floor
  const auto way = level.longestWay();
  ASSERT_GT(way.size(), 90U);
  for (std::size_t i = 1; i < way.size(); ++i) {
    EXPECT_TRUE(level.clear(way[i]));
    EXPECT_LE(std::abs(way[i].x - way[i - 1].x), 1);
    EXPECT_LE(std::abs(way[i].y - way[i - 1].y), 1);
  }
}

}  // namespace
}  // namespace paloc::synth

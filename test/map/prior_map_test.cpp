#include "paloc/map/prior_map.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <random>
#include <vector>

#include "paloc/core/errors.h"
#include "simulated_rooms.h"

namespace paloc {
namespace {

TEST(PriorMap, NearestEqualsBruteForce) {
  const auto map = PriorMap::build(test::sampleMap(test::furnishedRoom(), 0.2, 0.005, 1), {});
  std::mt19937 random(2);
  std::uniform_real_distribution<float> uniform(-6, 8);
  for (int i = 0; i < 300; ++i) {
    const Point3f query{uniform(random), uniform(random), uniform(random) / 3};
    float best = 1e30F;
    for (std::uint32_t k = 0; k < map->size(); ++k) {
      const Point3f& p = map->point(k);
      const float dx = p.x - query.x, dy = p.y - query.y, dz = p.z - query.z;
      best = std::min(best, dx * dx + dy * dy + dz * dz);
    }
    const PriorMap::Nearest nearest = map->nearest(query, 1.0F);
    EXPECT_EQ(nearest.found(), best < 1.0F);
    if (nearest.found()) {
      EXPECT_FLOAT_EQ(nearest.distance_sq, best);
    }
  }
}

// A floor and a wall, some way from the origin of the local frame, where single precision is
// coarse.
PointCloud cornerAt(const Point3f& corner, float spacing_m, int points_across) {
  PointCloud cloud;
  std::mt19937 random(3);
  std::uniform_real_distribution<float> uniform(0, 0.7F * spacing_m);
  for (int i = 0; i < points_across; ++i) {
    for (int k = 0; k < points_across; ++k) {
      const auto u = static_cast<float>(i) * spacing_m + uniform(random),
                 v = static_cast<float>(k) * spacing_m + uniform(random);
      cloud.points.push_back({corner.x + u, corner.y + v, corner.z});
      cloud.points.push_back({corner.x, corner.y + u, corner.z + v});
    }
  }
  return cloud;
}

struct NearMap {
  Point3f corner;
  float spacing_m;
  double voxel_m;
};

class NearestNearTheMap : public testing::TestWithParam<NearMap> {};

// Where the table of cubes answers: on its points, between them, on the borders of its cubes.
TEST_P(NearestNearTheMap, EqualsBruteForceOneByOneAndTogether) {
  const auto& [corner, spacing_m, voxel_m] = GetParam();
  MapSettings settings;
  settings.voxel_m = voxel_m;
  settings.plane_max_radius_m = 4 * static_cast<double>(spacing_m);
  const auto map = PriorMap::build(cornerAt(corner, spacing_m, 40), settings);
  std::mt19937 random(4);
  std::normal_distribution<float> off(0, 0.7F * spacing_m);
  std::uniform_int_distribution<std::uint32_t> any(0, static_cast<std::uint32_t>(map->size() - 1));
  const float within_m = 3 * spacing_m;
  std::vector<PriorMap::Query> queries;
  std::vector<float> nearest_sq;
  for (int i = 0; i < 500; ++i) {
    const Point3f about = map->point(any(random));
    Point3f query{about.x + off(random), about.y + off(random), about.z + off(random)};
    if (i % 3 == 0) query.x = std::round(query.x / 0.4F) * 0.4F;  // a border
    float best = within_m * within_m;
    for (std::uint32_t k = 0; k < map->size(); ++k) {
      const Point3f& p = map->point(k);
      const float dx = p.x - query.x, dy = p.y - query.y, dz = p.z - query.z;
      best = std::min(best, dx * dx + dy * dy + dz * dz);
    }
    const PriorMap::Nearest nearest = map->nearest(query, within_m);
    ASSERT_EQ(nearest.found(), best < within_m * within_m);
    if (nearest.found()) {
      ASSERT_FLOAT_EQ(nearest.distance_sq, best);
    }
    queries.push_back({query, i % 2 == 0 ? any(random) : PriorMap::kNoPoint});
    nearest_sq.push_back(nearest.found() ? nearest.distance_sq : -1);
  }
  std::vector<PriorMap::Nearest> together(queries.size());
  const Point3f viewer{corner.x + 5, corner.y + 5, corner.z + 5};  // sees both
  map->nearestSeenFrom(viewer, within_m, queries, together);
  for (std::size_t i = 0; i < queries.size(); ++i) {
    ASSERT_EQ(together[i].found() ? together[i].distance_sq : -1, nearest_sq[i]) << i;
  }
}

INSTANTIATE_TEST_SUITE_P(Maps, NearestNearTheMap,
                         testing::Values(NearMap{{0, 0, 0}, 0.1F, 0.05},
                                         NearMap{{-7.3F, 2.1F, -1.9F}, 0.03F, 0.05},
                                         NearMap{{-7.3F, 2.1F, -1.9F}, 0.01F, 0},
                                         NearMap{{3000, -2500, 40}, 0.1F, 0.05},
                                         NearMap{{12, 30, 1}, 1.0F, 0.05}));

// A room with walls of 12 cm, looked at from its middle: many a query lies nearer to a face that
// cannot be seen from there.
TEST(PriorMap, TheNearestThatCanBeSeenEqualsBruteForce) {
  PointCloud cloud;
  std::mt19937 random(6);
  std::uniform_real_distribution<float> along(-3, 3);
  std::normal_distribution<float> noise(0, 0.002F);
  for (const float face : {-2.12F, -2.0F, 2.0F, 2.12F}) {
    for (int i = 0; i < 4000; ++i) {
      cloud.points.push_back({face + noise(random), along(random), 0.5F * along(random)});
    }
  }
  const auto map = PriorMap::build(cloud, {});
  const Vec3 viewer(0.1, -0.2, 0.1);
  const auto vec = [](const Point3f& p) { return Vec3(p.x, p.y, p.z); };
  const auto seen = [&](std::uint32_t i) {
    const MapPlane plane = map->plane(i);
    return !plane.oriented ||
           Vec3(plane.nx, plane.ny, plane.nz).dot(viewer - vec(map->point(i))) > 0;
  };
  const float within_m = 0.6F;  // wider than a cube of the index
  std::vector<PriorMap::Query> queries;
  std::uniform_real_distribution<float> across(1.7F, 2.5F);
  for (int i = 0; i < 400; ++i) {
    const float side = i % 2 == 0 ? 1 : -1;
    queries.push_back({{side * across(random), along(random), 0.5F * along(random)}});
  }
  std::vector<PriorMap::Nearest> found(queries.size());
  map->nearestSeenFrom({0.1F, -0.2F, 0.1F}, within_m, queries, found);
  int behind = 0;
  for (std::size_t i = 0; i < queries.size(); ++i) {
    double any_sq = within_m * within_m, seen_sq = any_sq;
    for (std::uint32_t k = 0; k < map->size(); ++k) {
      const double sq = (vec(map->point(k)) - vec(queries[i].local)).squaredNorm();
      any_sq = std::min(any_sq, sq);
      if (sq < seen_sq && seen(k)) seen_sq = sq;
    }
    behind += seen_sq > any_sq && seen_sq < within_m * within_m;
    ASSERT_TRUE(found[i].found());
    // Where none can be seen, the nearest of all.
    const double expected_sq = seen_sq < within_m * within_m ? seen_sq : any_sq;
    EXPECT_NEAR(std::sqrt(found[i].distance_sq), std::sqrt(expected_sq), 1e-5) << i;
  }
  EXPECT_GT(behind, 50);
}

TEST(PriorMap, PointsInOnePlaceMakeNoPlane) {
  PointCloud cloud;
  cloud.points.assign(500, {1, 2, 3});
  MapSettings settings;
  settings.voxel_m = 0;
  try {
    PriorMap::build(cloud, settings, "heap");
    FAIL() << "a map was built";
  } catch (const IoError& error) {
    EXPECT_STREQ(error.what(),
                 "heap holds no surface: of its 500 points (thinned), 0 lie on a plane");
  }
}

TEST(PriorMap, PlanesLieOnTheWalls) {
  const test::BoxWorld world = test::emptyRoom();
  const auto map = PriorMap::build(test::sampleMap(world, 0.1, 0.003, 1), {});
  EXPECT_GT(map->statistics().planar, map->size() * 8 / 10);
  int checked = 0, on_floor = 0;
  for (std::uint32_t k = 0; k < map->size(); ++k) {
    const Point3f& p = map->point(k);
    // On the floor, clear of the walls.
    if (p.z > 0.02F || std::abs(p.x) > 4.5F || std::abs(p.y) > 3.5F) continue;
    const MapPlane plane = map->plane(k);
    ++on_floor;
    if (!plane.planar()) continue;  // a point far out in the noise
    EXPECT_GT(std::abs(plane.nz), 0.995F);
    EXPECT_LT(plane.thickness_m, 0.006F);
    EXPECT_LT(std::abs(p.z + plane.offset_m * plane.nz), 0.005F);  // the plane is at z = 0
    ++checked;
  }
  EXPECT_GT(checked, 3000);
  EXPECT_GT(checked, on_floor * 97 / 100);
}

TEST(PriorMap, FacesOfAThinWallAreKeptApart) {
  PointCloud cloud;
  std::mt19937 random(7);
  std::normal_distribution<float> noise(0, 0.003F);
  std::uniform_real_distribution<float> uniform(0, 0.05F);
  for (int i = 0; i < 40; ++i) {
    for (int k = 0; k < 40; ++k) {
      const float x = 0.05F * static_cast<float>(i), z = 0.05F * static_cast<float>(k);
      cloud.points.push_back({x + uniform(random), noise(random), z + uniform(random)});
      cloud.points.push_back({x + uniform(random), 0.1F + noise(random), z + uniform(random)});
    }
  }
  const auto map = PriorMap::build(cloud, {.plane_neighbours = 24});
  std::size_t right = 0, wrong = 0;
  for (std::uint32_t k = 0; k < map->size(); ++k) {
    const MapPlane plane = map->plane(k);
    if (!plane.planar()) continue;
    const Point3f& p = map->point(k);
    const float face = p.y > 0.05F ? 0.1F : 0.0F;
    const bool on_face = std::abs(p.y + plane.offset_m * plane.ny - face) < 0.015F;
    ++(on_face && std::abs(plane.ny) > 0.98F ? right : wrong);
  }
  EXPECT_GT(right, map->size() * 8 / 10);
  EXPECT_LT(wrong, map->size() / 10);
}

// A step, each face with a point in every square of 2.5 cm, thinned to 3 cm as it is read: what is
// left at its edge are also means of points of both faces.
TEST(PriorMap, APlaneAtAnEdgeIsThatOfOneFace) {
  std::mt19937 random(5);
  std::normal_distribution<float> noise(0, 0.002F);
  std::uniform_real_distribution<float> within(0, 0.025F);
  PointCloud cloud;
  for (int i = 0; i < 160; ++i) {
    for (int k = 0; k < 12; ++k) {
      const auto x = 0.025F * static_cast<float>(i), y = 0.025F * static_cast<float>(k);
      cloud.points.push_back({x + within(random), y + within(random), noise(random)});
      cloud.points.push_back({x + within(random), noise(random), -y - within(random)});
    }
  }
  MapSettings settings;
  settings.voxel_m = 0.03;
  const auto map = PriorMap::build(cloud, settings);
  int planes = 0, between = 0;
  for (std::uint32_t i = 0; i < map->size(); ++i) {
    const MapPlane plane = map->plane(i);
    if (!plane.planar() || plane.thickness_m > 0.005F) continue;
    ++planes;
    between += std::max(std::abs(plane.ny), std::abs(plane.nz)) < 0.985F ? 1 : 0;  // 10 degrees
  }
  EXPECT_GT(planes, static_cast<int>(map->size()) / 2);
  EXPECT_LT(between, planes / 120);
}

TEST(PriorMap, ABushIsNotPlanar) {
  PointCloud cloud = test::sampleMap(test::emptyRoom(), 0.2, 0.003, 1);
  std::mt19937 random(9);
  std::uniform_real_distribution<float> uniform(-0.5F, 0.5F);
  for (int i = 0; i < 2000; ++i)
    cloud.points.push_back({uniform(random), uniform(random), 1.5F + uniform(random)});
  const auto map = PriorMap::build(cloud, {});
  std::size_t bush = 0, planar = 0;
  for (std::uint32_t k = 0; k < map->size(); ++k) {
    const Point3f& p = map->point(k);
    if (std::abs(p.x) > 0.4F || std::abs(p.y) > 0.4F || p.z < 1.1F || p.z > 1.9F) continue;
    ++bush;
    planar += map->plane(k).planar();
  }
  ASSERT_GT(bush, 500U);
  EXPECT_LT(planar, bush / 4);
}

TEST(PriorMap, SameBytesOnOneThreadAndTwo) {
  const PointCloud cloud = test::sampleMap(test::furnishedRoom(), 0.08, 0.005, 1);
  MapSettings settings;
  settings.threads = 1;
  const auto one = PriorMap::build(cloud, settings);
  settings.threads = 2;
  const auto two = PriorMap::build(cloud, settings);
  ASSERT_EQ(one->size(), two->size());
  for (std::uint32_t k = 0; k < one->size(); ++k) {
    const Point3f point_one = one->point(k), point_two = two->point(k);
    ASSERT_EQ(std::memcmp(&point_one, &point_two, sizeof(Point3f)), 0);
    ASSERT_EQ(one->plane(k), two->plane(k));
  }
}

TEST(PriorMap, UselessCloudsAreRefused) {
  EXPECT_THROW(PriorMap::build({}, {}), IoError);
  PointCloud line;
  for (int i = 0; i < 1000; ++i) line.points.push_back({0.1F * static_cast<float>(i), 0, 0});
  EXPECT_THROW(PriorMap::build(line, {}), IoError);
  line.points.push_back({1e9F, 0, 0});
  EXPECT_THROW(PriorMap::build(line, {}), IoError);
}

}  // namespace
}  // namespace paloc

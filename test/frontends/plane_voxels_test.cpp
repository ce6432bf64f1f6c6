#include "paloc/frontends/plane_voxels.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <map>
#include <random>
#include <tuple>

#include "paloc/frontends/local_voxel_map.h"

namespace paloc {
namespace {

constexpr double kNoise = 0.01;  // m

/// Points of the plane z = 0.2 x + 1 with noise along its normal, seen from above.
struct NoisyPlane {
  explicit NoisyPlane(unsigned seed) : random(seed) {}

  Vec3 normal = Vec3(-0.2, 0, 1).normalized();
  Vec3 ray = Vec3(0.1, 0.2, -1);
  std::mt19937 random;
  std::uniform_real_distribution<double> along{-3, 3};
  std::normal_distribution<double> noise{0, kNoise};

  Vec3 point() {
    const double x = along(random), y = along(random);
    return Vec3(x, y, 0.2 * x + 1) + noise(random) * normal;
  }
};

std::tuple<long, long, long> voxelOf(const Vec3& p, double edge) {
  const auto index = [&](double x) { return std::lround(std::floor(x / edge)); };
  return {index(p.x()), index(p.y()), index(p.z())};
}

TEST(PlaneVoxels, AreThoseOfBruteForce) {
  NoisyPlane plane(1);
  constexpr double kEdge = 0.8;
  PlaneVoxels voxels(kEdge);
  std::map<std::tuple<long, long, long>, std::vector<Vec3>> by_voxel;
  // So few that no voxel takes fewer than it gets; each is fitted for the last time at some point
  // of its growth, which `points` tells.
  for (int i = 0; i < 4000; ++i) {
    const Vec3 p = plane.point();
    ASSERT_TRUE(voxels.add(p, plane.ray, 0));
    by_voxel[voxelOf(p, kEdge)].push_back(p);
  }
  EXPECT_EQ(voxels.size(), by_voxel.size());
  int compared = 0;
  for (const auto& [key, points] : by_voxel) {
    LocalPlane found;
    if (!voxels.find(points.front(), plane.ray, found)) continue;
    ASSERT_LE(found.points, static_cast<int>(points.size()));
    Vec3 mean = Vec3::Zero();
    for (int i = 0; i < found.points; ++i) mean += points[static_cast<std::size_t>(i)];
    mean /= found.points;
    Mat3 scatter = Mat3::Zero();
    for (int i = 0; i < found.points; ++i) {
      const Vec3 d = points[static_cast<std::size_t>(i)] - mean;
      scatter += d * d.transpose();
    }
    const Eigen::SelfAdjointEigenSolver<Mat3> solver(scatter);
    EXPECT_LT((found.centroid - mean).norm(), 1e-5);
    EXPECT_GT(found.normal.dot(plane.normal), 0) << "towards the side that it is seen from";
    EXPECT_GT(std::abs(found.normal.dot(solver.eigenvectors().col(0))), 1 - 1e-6);
    EXPECT_NEAR(found.thickness_m, std::sqrt(solver.eigenvalues()[0] / (found.points - 3)), 2e-5);
    ++compared;
  }
  EXPECT_GT(compared, 40);
}

/// Points of the wall x = 2.1 between the given elevations (rad), seen from zero, with noise of the
/// range.
std::vector<Vec3> seenOfAWall(double lowest, double highest, int count) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> azimuth(0.005, 0.23), elevation(lowest, highest);
  std::normal_distribution<double> noise(0, 0.03);
  std::vector<Vec3> points;
  for (int i = 0; i < count; ++i) {
    const double up = elevation(random);
    const Vec3 direction(1, std::tan(azimuth(random)), std::tan(up));
    const double range = 2.1 * direction.norm() + noise(random);
    points.push_back(range * direction.normalized());
  }
  return points;
}

// A ring's points on a wall lie on the ring's own plane, as exactly as the sensor turns evenly: not
// a surface. (A map of a stairwell was full of such level planes, 4 mm thin, at any height.)
TEST(PlaneVoxels, ASingleRingIsNoPlane) {
  PlaneVoxels voxels(0.2);
  LocalPlane found;
  for (const Vec3& p : seenOfAWall(0.04, 0.042, 200)) {
    voxels.add(p, p, 0);
    EXPECT_FALSE(voxels.find(p, Vec3(1, 0, -0.3), found)) << found.normal.transpose();
  }
}

TEST(PlaneVoxels, SeveralRingsAre) {
  PlaneVoxels voxels(0.5);
  for (const Vec3& p : seenOfAWall(0.01, 0.15, 240)) voxels.add(p, p, 0);
  LocalPlane found;
  ASSERT_TRUE(voxels.find(Vec3(2.1, 0.1, 0.1), Vec3(1, 0, 0), found));
  EXPECT_LT(found.normal.x(), -0.99);
}

// Of a floor far away few millimetres are seen across the rays, yet these tell its normal well: the
// noise of the ranges moves points along it.
TEST(PlaneVoxels, AGrazedFloorIsAPlane) {
  PlaneVoxels voxels(0.2);
  std::mt19937 random(6);
  std::uniform_real_distribution<double> x(4.01, 4.19), y(0.01, 0.19);
  std::normal_distribution<double> noise(0, 0.03);
  for (int i = 0; i < 200; ++i) {
    const Vec3 p(x(random), y(random), -0.9);
    voxels.add(p + noise(random) * p.normalized(), p, 0);
  }
  LocalPlane found;
  ASSERT_TRUE(voxels.find(Vec3(4.1, 0.1, -0.9), Vec3(4, 0, -0.9), found));
  EXPECT_GT(found.normal.z(), 0.98);
}

TEST(PlaneVoxels, TheTwoSidesOfAThinWallAreTwoPlanes) {
  PlaneVoxels voxels(0.5);
  std::mt19937 random(2);
  std::uniform_real_distribution<double> along(0.01, 0.49);
  std::normal_distribution<double> noise(0, 0.005);
  const Vec3 forward(1, 0, 0.1), back(-1, 0, 0.1);
  for (int i = 0; i < 200; ++i) {
    voxels.add({0.2 + noise(random), along(random), along(random)}, forward, 0);
  }
  for (int i = 0; i < 200; ++i) {
    voxels.add({0.3 + noise(random), along(random), along(random)}, back, 0);
  }
  LocalPlane front, behind;
  ASSERT_TRUE(voxels.find({0.25, 0.2, 0.2}, forward, front));
  ASSERT_TRUE(voxels.find({0.25, 0.2, 0.2}, back, behind));
  EXPECT_NEAR(front.centroid.x(), 0.2, 0.002);
  EXPECT_NEAR(behind.centroid.x(), 0.3, 0.002);
  EXPECT_LT(front.normal.x(), -0.99);
  EXPECT_GT(behind.normal.x(), 0.99);
}

TEST(PlaneVoxels, ALineAndACornerAreNoPlanes) {
  PlaneVoxels line(0.5), corner(0.5);
  std::mt19937 random(3);
  std::uniform_real_distribution<double> along(0.01, 0.49);
  std::normal_distribution<double> noise(0, 0.01);
  const Vec3 ray(1, 1, -1);
  for (int i = 0; i < 300; ++i) {
    line.add({along(random), 0.2 + noise(random), 0.2 + noise(random)}, ray, 0);
    const double a = along(random), b = along(random);
    corner.add(i % 2 == 0 ? Vec3(a, b, 0.01) : Vec3(0.49, a, b), ray, 0);
  }
  LocalPlane plane;
  EXPECT_FALSE(line.find({0.2, 0.2, 0.2}, ray, plane));
  EXPECT_FALSE(corner.find({0.2, 0.2, 0.01}, ray, plane));
}

TEST(PlaneVoxels, ForgetsTheFarAndThenTheOldest) {
  PlaneVoxels voxels(1);
  const Vec3 ray(0, 0, -1);
  const auto fill = [&](double x, std::uint32_t now) {
    for (int i = 0; i < 20; ++i) {
      voxels.add({x + 0.04 * i + 0.1, 0.5 + 0.3 * (i % 3 - 1), 0.5}, ray, now);
    }
  };
  for (int i = 0; i < 10; ++i) fill(i, static_cast<std::uint32_t>(i));
  fill(1000, 20);
  ASSERT_EQ(voxels.size(), 11U);
  voxels.forget(Vec3::Zero(), 100, 8);
  LocalPlane plane;
  EXPECT_EQ(voxels.size(), 6U) << "three quarters of what is allowed";
  EXPECT_FALSE(voxels.find({1000.5, 0.5, 0.5}, ray, plane)) << "too far, though the newest";
  EXPECT_FALSE(voxels.find({3.5, 0.5, 0.5}, ray, plane)) << "seen longest ago";
  EXPECT_TRUE(voxels.find({4.5, 0.5, 0.5}, ray, plane));
  EXPECT_TRUE(voxels.find({9.5, 0.5, 0.5}, ray, plane));
}

TEST(PlaneVoxels, PointsOutOfReachAreToldNotTaken) {
  PlaneVoxels voxels(0.2);
  EXPECT_FALSE(voxels.add({1e6, 0, 0}, Vec3::UnitX(), 0));
  EXPECT_FALSE(voxels.add({std::nan(""), 0, 0}, Vec3::UnitX(), 0));
  EXPECT_EQ(voxels.size(), 0U);
}

TEST(LocalVoxelMap, CoarseVoxelsServeWhereFineOnesHaveTooFew) {
  LocalVoxelMap map({.voxel_m = 0.2, .level_factor = 2.5, .levels = 3});
  NoisyPlane plane(4);
  for (int i = 0; i < 600; ++i) map.add(plane.point(), plane.ray);  // less than one a fine voxel
  int found = 0;
  LocalPlane p;
  for (int i = 0; i < 100; ++i) {
    const Vec3 x = plane.point();
    if (!map.find(x, plane.ray, p)) continue;
    ++found;
    EXPECT_LT(std::abs(p.height(x)), 6 * kNoise);
  }
  EXPECT_GT(found, 80);
}

TEST(LocalVoxelMap, MemoryIsBoundedOverAnEndlessWay) {
  LocalVoxelMap map({.max_voxels = 5000, .max_distance_m = 50});
  std::mt19937 random(5);
  std::uniform_real_distribution<double> off(-10, 10);
  std::size_t bytes_max = 0;
  for (int scan = 0; scan < 600; ++scan) {
    const Vec3 at(scan, 0, 0);
    for (int i = 0; i < 1500; ++i) {
      map.add(at + Vec3(off(random), off(random), -1), Vec3(0.1, 0, -1));
    }
    map.endScan(at);
    EXPECT_LE(map.voxels(), 15'000U);
    bytes_max = std::max(bytes_max, map.bytes());
  }
  EXPECT_LT(bytes_max, 10'000'000U);
}

}  // namespace
}  // namespace paloc

#include "paloc/map/scan_thinning.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <set>

namespace paloc {
namespace {

// A wall 3 m ahead of a scanner at `sensor`, with range noise, seen by rays in even steps of angle.
std::vector<Point3f> noisyWall(const Vec3& sensor, double noise_m, int side) {
  std::mt19937 random(3);
  std::normal_distribution<double> normal(0, noise_m);
  std::vector<Point3f> points;
  for (int column = 0; column < side; ++column) {
    for (int row = 0; row < side; ++row) {
      const double y = 1.2 * (2.0 * column / side - 1), z = 1.2 * (2.0 * row / side - 1);
      const Vec3 ray = Vec3(1, std::tan(y), std::tan(z)).normalized();
      const Vec3 p = sensor + (3 / ray.x() + normal(random)) * ray;
      points.push_back(
          {static_cast<float>(p.x()), static_cast<float>(p.y()), static_cast<float>(p.z())});
    }
  }
  return points;
}

TEST(ScanThinning, HoldsTheCapAndNearlyFillsIt) {
  const std::vector<Point3f> points = noisyWall(Vec3(0.3, 0, 1), 0.03, 300);
  ScanThinning thinning;
  for (const std::size_t cap : {1U, 2U, 100U, 3000U, 60000U}) {
    const std::vector<std::uint32_t> kept = thinning.select(points, Vec3(0.3, 0, 1), cap);
    EXPECT_LE(kept.size(), cap);
    EXPECT_GE(static_cast<double>(kept.size()), 0.95 * static_cast<double>(cap) - 1);
    EXPECT_TRUE(std::is_sorted(kept.begin(), kept.end()));
    EXPECT_EQ(std::set<std::uint32_t>(kept.begin(), kept.end()).size(), kept.size());
    EXPECT_EQ(kept, ScanThinning().select(points, Vec3(0.3, 0, 1), cap));
  }
  EXPECT_EQ(thinning.select(points, Vec3::Zero(), points.size()).size(), points.size());
}

// A voxel filter of 10 cm moves the mean by 5 to 10 mm here, since the wall lies near a border.
TEST(ScanThinning, NoiseHasNoSay) {
  for (const double offset : {0.0, 0.02, 0.05}) {
    const Vec3 sensor(offset, 0, 0);
    const std::vector<Point3f> points = noisyWall(sensor, 0.03, 600);
    const std::vector<std::uint32_t> kept = ScanThinning().select(points, sensor, 20000);
    double sum = 0, squares = 0;
    for (const std::uint32_t i : kept) {
      const double error = static_cast<double>(points[i].x) - 3 - offset;
      sum += error;
      squares += error * error;
    }
    const auto n = static_cast<double>(kept.size());
    EXPECT_LT(std::abs(sum / n), 4 * std::sqrt(squares / n / n)) << offset;
  }
}

// As many points on a square metre that is near as on one that is far.
TEST(ScanThinning, SpreadsPointsEvenlyOverSurfaces) {
  const std::vector<Point3f> points = noisyWall(Vec3::Zero(), 0, 800);
  const std::vector<std::uint32_t> kept = ScanThinning().select(points, Vec3::Zero(), 8000);
  int near = 0, far = 0;  // on a square about the middle, on one of the same size farther out
  for (const std::uint32_t i : kept) {
    const double y = std::abs(static_cast<double>(points[i].y)),
                 z = std::abs(static_cast<double>(points[i].z));
    near += y < 0.5 && z < 0.5 ? 1 : 0;
    far += y > 2 && y < 3 && z < 0.5 ? 1 : 0;
  }
  // Twice the squares out there, and their density falls with the slant, too, which is not undone.
  EXPECT_GT(near, 25);
  EXPECT_GT(far, near / 2);
  EXPECT_LT(far, 4 * near);
}

TEST(ScanThinning, OddPointsAreHarmless) {
  const float nan = std::numeric_limits<float>::quiet_NaN(), far = 1e30F;
  std::vector<Point3f> points(100, Point3f{nan, 0, 0});
  points.resize(200, Point3f{far, far, far});
  points.resize(300, Point3f{0, 0, 0});
  EXPECT_LE(ScanThinning().select(points, Vec3::Zero(), 50).size(), 50U);
  EXPECT_TRUE(ScanThinning().select({}, Vec3::Zero(), 50).empty());
}

}  // namespace
}  // namespace paloc

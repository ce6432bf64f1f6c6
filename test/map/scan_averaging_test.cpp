#include "paloc/map/scan_averaging.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <numeric>
#include <random>

namespace paloc {
namespace {

constexpr double kNoiseM = 0.03;
const Vec3 kSensor(0.3, -0.2, 1);

// Walls ahead of the scanner, as deep (m, along x) as `depth` says for a ray, seen with range noise
// by rays 0.35 degrees apart.
std::vector<Point3f> noisyWalls(const std::function<double(const Vec3& ray)>& depth) {
  std::mt19937 random(5);
  std::normal_distribution<double> noise(0, kNoiseM);
  std::vector<Point3f> points;
  for (int column = -100; column < 100; ++column) {
    for (int row = -60; row < 60; ++row) {
      const Vec3 ray = Vec3(1, std::tan(0.0061 * column), std::tan(0.0061 * row)).normalized();
      const Vec3 p = kSensor + (depth(ray) / ray.x() + noise(random)) * ray;
      points.push_back(
          {static_cast<float>(p.x()), static_cast<float>(p.y()), static_cast<float>(p.z())});
    }
  }
  return points;
}

std::vector<std::uint32_t> everyNthIndex(const std::vector<Point3f>& points, std::uint32_t step) {
  std::vector<std::uint32_t> seeds;
  for (std::uint32_t i = 7; i < points.size(); i += step) seeds.push_back(i);
  return seeds;
}

TEST(ScanAveraging, MeansHaveTheNoiseOfTheirNumberAndNoBias) {
  const std::vector<Point3f> points = noisyWalls([](const Vec3&) { return 4.0; });
  const std::vector<std::uint32_t> seeds = everyNthIndex(points, 97);
  const AveragedPoints averaged = ScanAveraging().average(points, seeds, kSensor, kNoiseM);
  ASSERT_EQ(averaged.points.size(), seeds.size());
  ASSERT_EQ(averaged.returns.size(), seeds.size());
  double sum = 0, squares = 0, returns = 0;
  for (std::size_t i = 0; i < seeds.size(); ++i) {
    const Vec3 ray =
        Vec3(averaged.points[i].x, averaged.points[i].y, averaged.points[i].z) - kSensor;
    const double sigma = kNoiseM * ray.x() / ray.norm() / std::sqrt(averaged.returns[i]);
    const double normalized = (ray.x() - 4) / sigma;
    sum += normalized;
    squares += normalized * normalized;
    returns += averaged.returns[i];
  }
  const auto n = static_cast<double>(seeds.size());
  EXPECT_GT(returns / n, 6);
  EXPECT_LT(std::abs(sum / n), 3 / std::sqrt(n));
  EXPECT_NEAR(squares / n, 1, 3 * std::sqrt(2 / n));
}

TEST(ScanAveraging, AReturnCountsOnceAndAllOfACellIfSeedsLieClose) {
  const std::vector<Point3f> points = noisyWalls([](const Vec3&) { return 2.0; });
  const std::vector<std::uint32_t> dense = everyNthIndex(points, 2);
  const AveragedPoints averaged = ScanAveraging().average(points, dense, kSensor, kNoiseM);
  const auto counted =
      std::accumulate(averaged.returns.begin(), averaged.returns.end(), std::size_t{0});
  EXPECT_LE(counted, points.size());
  EXPECT_GT(counted, points.size() * 99 / 100);
  for (const std::uint16_t returns : averaged.returns) EXPECT_GE(returns, 1);
}

TEST(ScanAveraging, AnotherSurfaceBehindDoesNotCount) {
  const auto depth = [](const Vec3& ray) { return ray.y() < 0.01 ? 3.0 : 3.6; };
  const std::vector<Point3f> points = noisyWalls(depth);
  const std::vector<std::uint32_t> seeds = everyNthIndex(points, 11);
  const AveragedPoints averaged = ScanAveraging().average(points, seeds, kSensor, kNoiseM);
  for (std::size_t i = 0; i < seeds.size(); ++i) {
    const Point3f& seed = points[seeds[i]];
    const double wall = seed.x - kSensor.x() < 3.3 ? 3.0 : 3.6;
    EXPECT_NEAR(averaged.points[i].x - kSensor.x(), wall, 4.5 * kNoiseM);
    const Vec3 apart(averaged.points[i].x - seed.x, averaged.points[i].y - seed.y,
                     averaged.points[i].z - seed.z);
    EXPECT_LT(apart.norm(), 0.25);
  }
}

TEST(ScanAveraging, TheOrderOfItsJobsChangesNothing) {
  const std::vector<Point3f> points = noisyWalls([](const Vec3& ray) { return 3 + ray.z(); });
  const std::vector<std::uint32_t> seeds = everyNthIndex(points, 41);
  std::size_t jobs = 0;
  const RunJobs backwards = [&](std::size_t count, const std::function<void(std::size_t)>& job) {
    for (std::size_t i = count; i-- > 0; ++jobs) job(i);
  };
  ScanAveraging averaging;
  const AveragedPoints first = averaging.average(points, seeds, kSensor, kNoiseM);
  const AveragedPoints again = averaging.average(points, seeds, kSensor, kNoiseM, backwards);
  EXPECT_GT(jobs, 1U);
  EXPECT_EQ(first.returns, again.returns);
  ASSERT_EQ(first.points.size(), again.points.size());
  for (std::size_t i = 0; i < first.points.size(); ++i) {
    EXPECT_EQ(first.points[i].x, again.points[i].x);
    EXPECT_EQ(first.points[i].y, again.points[i].y);
    EXPECT_EQ(first.points[i].z, again.points[i].z);
  }
}

TEST(ScanAveraging, OddPointsAreHarmless) {
  constexpr float kNaN = std::numeric_limits<float>::quiet_NaN(),
                  kInf = std::numeric_limits<float>::infinity();
  const std::vector<Point3f> points = {
      {kNaN, 1, 2}, {kInf, kInf, -kInf}, {0.3F, -0.2F, 1.0F}, {1e30F, 1, 1}, {5, 5, 5}};
  const std::vector<std::uint32_t> seeds = {0, 1, 2, 3, 4};
  const AveragedPoints averaged = ScanAveraging().average(points, seeds, kSensor, kNoiseM);
  ASSERT_EQ(averaged.points.size(), seeds.size());
  EXPECT_EQ(averaged.points[4].x, 5);
  EXPECT_EQ(averaged.returns, std::vector<std::uint16_t>(5, 1));
  EXPECT_TRUE(ScanAveraging().average({}, {}, kSensor, kNoiseM).points.empty());
}

TEST(AveragedPoints, EveryNthKeepsPointsAndReturnsTogether) {
  AveragedPoints all;
  for (int i = 0; i < 10; ++i) {
    all.points.push_back({static_cast<float>(i), 0, 0});
    all.returns.push_back(static_cast<std::uint16_t>(i + 1));
  }
  const AveragedPoints some = all.everyNth(3);
  ASSERT_EQ(some.points.size(), 4U);
  EXPECT_EQ(some.points[2].x, 6);
  EXPECT_EQ(some.returns[2], 7);
}

}  // namespace
}  // namespace paloc

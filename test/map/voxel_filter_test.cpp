#include "paloc/map/voxel_filter.h"

#include <gtest/gtest.h>

#include <map>
#include <random>
#include <tuple>

namespace paloc {
namespace {

std::vector<Point3f> randomPoints(std::size_t count, float extent) {
  std::mt19937 random(5);
  std::uniform_real_distribution<float> uniform(-extent, extent);
  std::vector<Point3f> points(count);
  for (Point3f& p : points) p = {uniform(random), uniform(random), uniform(random)};
  return points;
}

std::tuple<long, long, long> voxelOf(const Point3f& p, double voxel) {
  const auto number = [voxel](float v) {
    return std::lround(std::floor(static_cast<double>(v) / voxel));
  };
  return {number(p.x), number(p.y), number(p.z)};
}

TEST(VoxelFilter, KeepsThePointNearestToEachCentroid) {
  const std::vector<Point3f> points = randomPoints(5000, 2);
  constexpr double kVoxel = 0.5;
  std::map<std::tuple<long, long, long>, std::vector<std::uint32_t>> voxels;
  for (std::uint32_t i = 0; i < points.size(); ++i) voxels[voxelOf(points[i], kVoxel)].push_back(i);
  const std::vector<std::uint32_t> kept = VoxelFilter().select(points, kVoxel);
  ASSERT_EQ(kept.size(), voxels.size());
  const auto toVec = [&](std::uint32_t i) {
    return Eigen::Vector3f(points[i].x, points[i].y, points[i].z).cast<double>().eval();
  };
  for (std::uint32_t index : kept) {
    const auto& members = voxels.at(voxelOf(points[index], kVoxel));
    Vec3 centroid = Vec3::Zero();
    for (std::uint32_t i : members) centroid += toVec(i) / static_cast<double>(members.size());
    for (std::uint32_t i : members) {
      EXPECT_LE((toVec(index) - centroid).norm(), (toVec(i) - centroid).norm() + 1e-9);
    }
  }
}

TEST(VoxelFilter, FarPointsAndNoPointsAreHarmless) {
  const std::vector<Point3f> points{{1e30F, -1e30F, 0}, {1e30F, -1e30F, 0.01F}, {0, 0, 0}};
  EXPECT_EQ(VoxelFilter().select(points, 0.001).size(), 3U);
  EXPECT_TRUE(VoxelFilter().select({}, 0.1).empty());
}

}  // namespace
}  // namespace paloc

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <map>
#include <random>

#include "cloud_files.h"
#include "paloc/map/prior_map.h"

namespace paloc {
namespace {

using test::pointOf;

PointCloud randomCloud(int points, const Vec3& origin) {
  PointCloud cloud;
  cloud.origin = origin;
  std::mt19937 random(1);
  std::uniform_real_distribution<float> uniform(-4, 4);
  for (int i = 0; i < points; ++i) {
    cloud.points.push_back({uniform(random), uniform(random), uniform(random) / 4});
    cloud.intensity.push_back(uniform(random));
  }
  return cloud;
}

struct Sum {
  Vec3 position = Vec3::Zero();
  double intensity = 0, points = 0;
};

TEST(ThinnedLoading, GivesTheCentroidsOfTheVoxels) {
  const test::TempDir folder;
  constexpr double kEdge = 0.25;
  savePly(folder / "a.ply", randomCloud(200'000, Vec3(500'000, 5'400'000, 100)));
  const PointCloud cloud = loadCloud(folder / "a.ply");
  const PointCloud thinned = loadCloud(folder / "a.ply", {.voxel_m = kEdge});
  ASSERT_EQ(thinned.origin, cloud.origin);
  EXPECT_EQ(thinned.points_read, cloud.size());
  std::map<std::array<int, 3>, Sum> voxels;
  const auto voxelOf = [&](const Vec3& local) {
    return std::array<int, 3>{static_cast<int>(std::floor(local.x() / kEdge)),
                              static_cast<int>(std::floor(local.y() / kEdge)),
                              static_cast<int>(std::floor(local.z() / kEdge))};
  };
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const Vec3 local = pointOf(cloud, i) - cloud.origin;
    Sum& sum = voxels[voxelOf(local)];
    sum.position += local;
    sum.intensity += static_cast<double>(cloud.intensity[i]);
    sum.points += 1;
  }
  ASSERT_EQ(thinned.size(), voxels.size());
  for (std::size_t i = 0; i < thinned.size(); ++i) {
    const Vec3 local = pointOf(thinned, i) - thinned.origin;
    const Sum& sum = voxels.at(voxelOf(local));
    ASSERT_LT((local - sum.position / sum.points).norm(), 1e-5);
    ASSERT_NEAR(static_cast<double>(thinned.intensity[i]), sum.intensity / sum.points, 1e-4);
  }
}

TEST(ThinnedLoading, MakesTheSamePriorMapAsThinningAfterwards) {
  const test::TempDir folder;
  savePly(folder / "a.ply", randomCloud(100'000, Vec3::Zero()));
  const MapSettings settings{.voxel_m = 0.2};
  const auto on_load = PriorMap::load(folder / "a.ply", settings);
  const auto after = PriorMap::build(loadCloud(folder / "a.ply"), settings);
  ASSERT_EQ(on_load->size(), after->size());
  EXPECT_EQ(on_load->statistics().points_read, 100'000U);
  for (std::uint32_t i = 0; i < after->size(); ++i) {
    ASSERT_NEAR(on_load->point(i).x, after->point(i).x, 1e-6F);
    ASSERT_NEAR(on_load->point(i).y, after->point(i).y, 1e-6F);
    ASSERT_NEAR(on_load->point(i).z, after->point(i).z, 1e-6F);
  }
}

TEST(ThinnedLoading, ProgressRunsToTheEnd) {
  const test::TempDir folder;
  savePly(folder / "a.ply", randomCloud(1'000'000, Vec3::Zero()));
  double last = 0;
  int calls = 0;
  loadCloud(folder / "a.ply", {.progress = [&](double share) {
              EXPECT_GT(share, last);
              EXPECT_LE(share, 1);
              last = share;
              ++calls;
            }});
  EXPECT_GE(calls, 3);
  EXPECT_GT(last, 0.7);
}

TEST(ThinnedLoading, MemoryIsComparedBeforeItIsTaken) {
  const test::TempDir folder;
  savePly(folder / "a.ply", randomCloud(1'000'000, Vec3::Zero()));
  const std::string whole = test::refusal(folder / "a.ply", {.memory_limit_bytes = 10'000'000});
  EXPECT_NE(
      whole.find(
          "a.ply: a cloud of its 1000000 points needs 0.02 GB of memory, but the limit is 0.01"),
      std::string::npos)
      << whole;
  // Few voxels take little, whatever the file holds; too many are refused as they grow.
  EXPECT_EQ(test::refusal(folder / "a.ply", {.voxel_m = 0.5, .memory_limit_bytes = 10'000'000}),
            "");
  const std::string voxels =
      test::refusal(folder / "a.ply", {.voxel_m = 0.01, .memory_limit_bytes = 10'000'000});
  EXPECT_NE(voxels.find("thinned to voxels of 0.01 m, it needs"), std::string::npos) << voxels;
}

TEST(ThinnedLoading, AStrayPointFarOffIsRefused) {
  const test::TempDir folder;
  PointCloud cloud = randomCloud(10'000, Vec3::Zero());
  cloud.points.push_back({1e6F, 0, 0});
  cloud.intensity.push_back(0);
  savePly(folder / "a.ply", cloud);
  const std::string sentence = test::refusal(folder / "a.ply", {.voxel_m = 0.05});
  EXPECT_NE(sentence.find("a point is 1000 km off, too far for voxels of 0.05 m"),
            std::string::npos)
      << sentence;
}

}  // namespace
}  // namespace paloc

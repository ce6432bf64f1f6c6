#include "paloc/map/surface_patches.h"

#include <gtest/gtest.h>

#include <random>

namespace paloc {
namespace {

// Rows on the planes z = 0 (patch 0), x = 2 (patch 1) and one point on y = 4 (patch 2).
std::vector<PlaneRow> rowsOnPlanes() {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> uniform(-1, 1);
  std::vector<PlaneRow> rows;
  const auto add = [&](const Vec3& normal, const Vec3& point, int patch) {
    PlaneRow row;
    row.normal_body = normal;
    row.point_body = point;
    row.variance = 1e-4 * (1.5 + uniform(random));
    row.patch = patch;
    rows.push_back(row);
  };
  for (int k = 0; k < 400; ++k) {
    add(Vec3::UnitZ(), Vec3(3 * uniform(random), 3 * uniform(random), 0), 0);
    add(-Vec3::UnitX(), Vec3(2, 3 * uniform(random), uniform(random)), 1);
    add(-Vec3::UnitY(), Vec3(3 * uniform(random), 5, uniform(random)), -1);
  }
  add(-Vec3::UnitY(), Vec3(1, 4, 0.5), 2);
  return rows;
}

TEST(SurfacePatches, TheirGradientsMakeUpTheSpread) {
  const std::vector<PlaneRow> rows = rowsOnPlanes();
  constexpr double kBias_m = 0.004;
  const SharedErrors shared{std::vector<double>(3, kBias_m * kBias_m), 0};
  const Mat6 spread = sharedSpread(rows, shared);
  std::vector<SurfacePatch> patches = surfacePatches(rows);
  ASSERT_EQ(patches.size(), 3U);
  keepWhatMatters(leastSquares(rows).information, spread, kBias_m, patches);
  ASSERT_EQ(patches.size(), 2U) << "one point does not matter";
  Mat6 sum = Mat6::Zero();
  for (const SurfacePatch& patch : patches) {
    sum += kBias_m * kBias_m * patch.gradient * patch.gradient.transpose();
  }
  EXPECT_LT((sum - spread).norm(), 1e-3 * spread.norm());
  EXPECT_LT((patches[0].normal - Vec3::UnitZ()).norm(), 1e-12);
  EXPECT_NEAR(patches[0].point.z(), 0, 1e-12);
  EXPECT_NEAR(patches[1].point.x(), 2, 1e-12);
}

TEST(SurfacePatches, NoneMattersWithoutABias) {
  std::vector<SurfacePatch> patches = surfacePatches(rowsOnPlanes());
  keepWhatMatters(leastSquares(rowsOnPlanes()).information, Mat6::Zero(), 0, patches);
  EXPECT_TRUE(patches.empty());
  EXPECT_TRUE(surfacePatches(std::span<const PlaneRow>()).empty());
}

}  // namespace
}  // namespace paloc

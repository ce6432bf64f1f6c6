#include "paloc/frontends/weak_direction.h"

#include <gtest/gtest.h>

#include <random>

namespace paloc {
namespace {

/// Points of walls x = 3 and y = 3, seen from zero, and as many of a floor as asked; a map of them.
struct Place {
  explicit Place(int on_floor) : map(LocalMapSettings{}) {
    std::mt19937 random(3);
    std::uniform_real_distribution<double> along(-2.9, 2.9), up(-0.9, 0.9);
    for (int i = 0; i < 10000; ++i) {
      add(i % 2 == 0 ? Vec3(3, along(random), up(random)) : Vec3(along(random), 3, up(random)));
    }
    for (int i = 0; i < on_floor; ++i) add(Vec3(along(random) / 5, along(random) / 5, -1));
    map.endScan(Vec3::Zero());
  }
  void add(const Vec3& point) {
    points.push_back({point, point, point, 0, 0});
    map.add(point, point);
    const Vec3 normal(point.x() == 3, point.y() == 3, point.z() == -1);
    normals += normal * normal.transpose();
  }

  LocalVoxelMap map;
  std::vector<PlacedPoint> points;
  Mat3 normals = Mat3::Zero();
};

TEST(WeakDirection, IsToldByAllPointsThatFaceIt) {
  const Place place(400);
  const auto weak = weakDirection(place.normals);
  ASSERT_TRUE(weak);
  EXPECT_NEAR(std::abs(weak->axis.z()), 1, 1e-9);
  EXPECT_NEAR(weak->missing, 0.1 * 10400 - 400, 1e-6);
  constexpr std::size_t kStep = 7;
  const auto more = pointsThatTell(*weak, place.points, kStep, place.map);
  EXPECT_GT(more.size(), 300U) << "of 343, but for voxels at the edge";
  for (const std::uint32_t i : more) {
    EXPECT_GE(i, 10000U) << "on the floor";
    EXPECT_NE(i % kStep, 0U) << "not used before";
  }
}

TEST(WeakDirection, IsNotToldByMoreThanAreMissing) {
  const Place place(400);
  const auto more = pointsThatTell({Vec3::UnitZ(), 100}, place.points, 7, place.map);
  EXPECT_GE(more.size(), 99U);
  EXPECT_LE(more.size(), 101U);
  for (std::size_t i = 1; i < more.size(); ++i) EXPECT_LT(more[i - 1], more[i]);
}

TEST(WeakDirection, IsNoneWhereATenthTellsEach) {
  EXPECT_FALSE(weakDirection(Place(1200).normals));
  EXPECT_FALSE(weakDirection(Mat3::Zero()));
}

}  // namespace
}  // namespace paloc

#include "paloc/frontends/line_matches.h"

#include <gtest/gtest.h>

#include <random>

#include "paloc/frontends/place_points.h"

namespace paloc {
namespace {

/// Points along a line through a place, `sigma_m` off it in each direction across.
std::vector<Vec3> alongLine(const Vec3& place, const Vec3& direction, int count, double sigma_m) {
  std::mt19937_64 random(3);
  std::normal_distribution<double> noise(0, sigma_m);
  std::uniform_real_distribution<double> along(-0.2, 0.2);
  std::vector<Vec3> points;
  for (int i = 0; i < count; ++i) {
    points.push_back(place + along(random) * direction +
                     Vec3(noise(random), noise(random), noise(random)));
  }
  return points;
}

TEST(LineVoxels, PointsAlongALineMakeIt) {
  LineVoxels map(0.5);
  const Vec3 place(1.75, -2.25, 0.25), direction = Vec3(0.1, -0.2, 1).normalized();
  for (const Vec3& p : alongLine(place, direction, 60, 0.01)) map.add(p);
  LocalLine line;
  ASSERT_TRUE(map.find(place, line));
  EXPECT_GT(std::abs(line.direction.dot(direction)), 0.999);
  EXPECT_LT((line.centroid - place).cross(direction).norm(), 0.005);
  EXPECT_NEAR(line.thickness_m, 0.01, 0.003);
  EXPECT_EQ(line.points, 60);
  EXPECT_GT(map.bytes(), 0U);
  EXPECT_FALSE(map.find(place + Vec3(5, 0, 0), line)) << "an empty voxel";
  EXPECT_FALSE(map.add(Vec3(1e7, 0, 0)));
  map.clear();
  EXPECT_FALSE(map.find(place, line));
}

TEST(LineVoxels, APatchOrFewPointsAreNoLine) {
  LineVoxels map(0.5);
  LocalLine line;
  const Vec3 place(0.25, 0.25, 0.25);
  for (const Vec3& p : alongLine(place, Vec3::UnitX(), 5, 0.001)) map.add(p);
  EXPECT_FALSE(map.find(place, line));
  for (const Vec3& p : alongLine(place, Vec3::UnitY(), 60, 0.001)) map.add(p);
  for (const Vec3& p : alongLine(place, Vec3::UnitX(), 60, 0.001)) map.add(p);
  EXPECT_FALSE(map.find(place, line)) << "a cross";
}

/// Position, rotation on the left and velocity at the end of a scan, moved by a small step.
Vec3 movedBy(const Vec9& d, const Vec3& position, const Vec3& lever, double age_s) {
  return position + d.head<3>() + so3::exp(d.segment<3>(3)) * lever - age_s * d.tail<3>();
}

// Both residuals by central differences: those of a line, and of the plane through it.
TEST(LineMatches, JacobiansOfPointToLineAndPointToPlaneAreThoseOfTheResiduals) {
  LocalLine line;
  line.direction = Vec3(0.3, -0.5, 0.8).normalized();
  line.centroid = Vec3(2, 1, -0.5);
  LocalPlane plane;
  plane.normal = Vec3(-0.2, 0.9, 0.4).normalized();
  plane.centroid = line.centroid;
  const Vec3 position(0.4, -0.3, 0.2), lever(1.7, 1.2, -0.6);
  constexpr double kAge = 0.07, kStep = 1e-6;
  const auto placed = [&](const Vec9& d) {
    return PlacedPoint{movedBy(d, position, lever, kAge), lever, lever, kAge};
  };
  const auto toLine = pointToLine(placed(Vec9::Zero()), line);
  const PointToPlane to_plane{plane.normal, lever, kAge, 0};
  EXPECT_NEAR(toLine[0].normal.dot(toLine[1].normal), 0, 1e-12);
  const double distance =
      (placed(Vec9::Zero()).point_odom - line.centroid).cross(line.direction).norm();
  EXPECT_NEAR(std::hypot(toLine[0].residual, toLine[1].residual), distance, 1e-12);
  for (int k = 0; k < 9; ++k) {
    const Vec9 d = kStep * Vec9::Unit(k);
    const auto above = pointToLine(placed(d), line), below = pointToLine(placed(-d), line);
    for (std::size_t i = 0; i < 2; ++i) {
      EXPECT_NEAR(jacobianOf<9>(toLine[i], 1)[k],
                  (above[i].residual - below[i].residual) / (2 * kStep), 1e-8)
          << k;
    }
    const double slope =
        (plane.height(placed(d).point_odom) - plane.height(placed(-d).point_odom)) / (2 * kStep);
    EXPECT_NEAR(jacobianOf<9>(to_plane, 1)[k], slope, 1e-8) << k;
  }
}

TEST(LineMatches, APoleTellsThePositionAcrossItAndNotAlongIt) {
  LineVoxels map(0.5);
  const Vec3 place(2.25, 1.25, 0.25);
  for (const Vec3& p : alongLine(place, Vec3::UnitZ(), 100, 0.01)) map.add(p);
  std::vector<PlacedPoint> points;
  for (const Vec3& p : alongLine(place + Vec3(0.02, 0, 0), Vec3::UnitZ(), 30, 0.01)) {
    points.push_back({p, p, p, 0});
  }
  points.push_back({Vec3(2.05, 1.05, 0.25), Vec3::UnitX(), Vec3::UnitX(), 0});  // off by 0.28 m
  LineMatches matches(0.005);
  matches.associate(points, map, 0.5);
  ASSERT_EQ(matches.size(), 31U);
  matches.weigh(0);
  PointToPlaneSums<9> sums;
  matches.addTo(sums, 0);
  const Mat3 information = sums.information.topLeftCorner<3, 3>();
  EXPECT_GT(information(0, 0), 30 / (0.03 * 0.03));
  EXPECT_LT(information(2, 2), 0.01 * information(0, 0));
  const Vec3 step = -sums.gradient.head<3>().cwiseQuotient(information.diagonal());
  EXPECT_NEAR(step.x(), -0.02, 0.006) << "the stray counts for little";
  EXPECT_NEAR(step.y(), 0, 0.006);
  matches.associate(points, map, 0.1);
  EXPECT_EQ(matches.size(), 30U) << "the stray is beyond the gate";
  matches.weigh(0);
  Mat9 noise = Mat9::Zero();
  matches.addNoiseTo(noise, 0);
  EXPECT_GT(noise(2, 2), 0) << "what the noise of directions pretends to know";
}

}  // namespace
}  // namespace paloc

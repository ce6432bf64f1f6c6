#include "paloc/frontends/plane_matches.h"

#include <gtest/gtest.h>

#include "walls.h"

namespace paloc {
namespace {

std::vector<PlacedPoint> placed(const std::vector<MeasuredPoint>& points, const Vec3& moved) {
  std::vector<PlacedPoint> result;
  for (const MeasuredPoint& p : points) {
    result.push_back({p.point_body + moved, p.point_body, p.point_body, p.age_s, 0});
  }
  return result;
}

TEST(PlaneMatches, MovedPointsKeepTheirPlanes) {
  const test::Walls room({0, 1, 2});
  PlaneMatches matches(0.005);
  matches.associate(placed(room.points, Vec3::Zero()), room.map, 0.5);
  matches.weigh(1);
  const auto before = matches.sums<18>(0);
  const Vec3 moved(0.002, -0.001, 0.003);
  matches.move(placed(room.points, moved));
  matches.weigh(1);
  const auto after = matches.sums<18>(0);
  // Residuals are linear in the move: the gradient changes by the information times it, but for
  // the weights.
  const Vec3 change = after.gradient.head<3>() - before.gradient.head<3>();
  const Vec3 expected = before.information.topLeftCorner<3, 3>() * moved;
  EXPECT_LT((change - expected).norm(), 0.1 * expected.norm());
  const Mat3 normals = matches.normals();
  EXPECT_NEAR(normals.trace(), static_cast<double>(matches.size()), 1e-4);
}

TEST(PlaneMatches, AnUnsureResidualIsWorthLess) {
  const test::Walls room({0, 1, 2});
  PlaneMatches matches(0.005);
  matches.associate(placed(room.points, Vec3::Zero()), room.map, 0.5);
  matches.weigh(0.1);
  const double sure = matches.sums<18>(0).information(0, 0);
  matches.weigh(0.1, 0.1);
  const double unsure = matches.sums<18>(0).information(0, 0);
  EXPECT_LT(unsure, 0.05 * sure);
  EXPECT_LT(unsure, static_cast<double>(matches.size()) / (0.1 * 0.1));
  EXPECT_GT(unsure, 0);
}

}  // namespace
}  // namespace paloc

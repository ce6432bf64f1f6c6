#include "paloc/map/degeneracy.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <numbers>

#include "paloc/core/mrpt_pose.h"
#include "paloc/map/scan_matcher.h"
#include "simulated_rooms.h"

namespace paloc {
namespace {

MapMatch matchIn(const test::BoxWorld& world, const Pose& T_world_body, double max_range_m) {
  const auto map = PriorMap::build(test::sampleMap(world, 0.1, 0.003, 1), {});
  const Pose truth = world.T_map_world * T_world_body;
  const Scan scan = test::simulateScan(world, truth, 12000, {0.02}, max_range_m, 11);
  Vec6 off;
  off << 0.05, -0.04, 0.03, 0.004, -0.003, 0.005;
  return ScanMatcher::onto(map, {})->match(scan, toMrpt(boxplus(truth, off)), 0.05, 0.01);
}

void expectPositiveSemidefinite(const Mat6& information) {
  EXPECT_TRUE(information.allFinite());
  EXPECT_EQ((information - information.transpose()).norm(), 0.0);
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, 6, 6>> solver(information);
  EXPECT_GE(solver.eigenvalues()[0], -1e-9 * solver.eigenvalues()[5]);
}

TEST(Degeneracy, AFurnishedRoomIsFullInAllSix) {
  const MapMatch match =
      matchIn(test::furnishedRoom(), {Vec3(-0.5, -0.3, 1.4), so3::exp(Vec3(0.02, 0.01, 0.5))}, 30);
  ASSERT_TRUE(match.accepted()) << toString(match.refusal);
  expectPositiveSemidefinite(match.information);
  for (const MatchDirection& direction : match.directions) {
    EXPECT_EQ(direction.cls, DirectionClass::kFull)
        << direction.axis_body.transpose() << " share " << direction.share << " p "
        << direction.probability;
  }
}

class CorridorTest : public testing::TestWithParam<double> {};

TEST_P(CorridorTest, IsFreeAlongItsAxisOnly) {
  const double yaw = GetParam() * std::numbers::pi / 180;
  const Pose T_world_body{Vec3(0.5, 0.2, 1.2), so3::exp(Vec3(0, 0, 0.7))};
  const test::BoxWorld world = test::corridor(yaw);
  const MapMatch match = matchIn(world, T_world_body, 15);
  ASSERT_TRUE(match.accepted()) << toString(match.refusal);
  expectPositiveSemidefinite(match.information);
  const Vec3 axis_body = T_world_body.rotation.transpose() * Vec3::UnitX();
  EXPECT_EQ(match.directions[0].cls, DirectionClass::kNone)
      << match.directions[0].share << " " << match.directions[0].probability;
  EXPECT_GT(std::abs(match.directions[0].axis_body.dot(axis_body)),
            std::cos(3 * std::numbers::pi / 180));
  for (std::size_t i = 1; i < 6; ++i) {
    const MatchDirection& d = match.directions[i];
    EXPECT_EQ(d.cls, DirectionClass::kFull)
        << i << " " << d.axis_body.transpose() << " share " << d.share << " p " << d.probability;
  }

  // No information along the axis with the rotation free, and the guess is kept there.
  const Vec3 axis_map = world.T_map_world.rotation * Vec3::UnitX();
  const Mat3 schur = match.information.topLeftCorner<3, 3>() -
                     match.information.topRightCorner<3, 3>() *
                         match.information.bottomRightCorner<3, 3>().inverse() *
                         match.information.bottomLeftCorner<3, 3>();
  EXPECT_LT(axis_map.dot(schur * axis_map), 0.02 * schur.trace());
  const Pose truth = world.T_map_world * T_world_body;
  const Vec3 error = fromMrpt(match.T_map_body).position - truth.position;
  EXPECT_NEAR(error.dot(axis_map), Vec3(0.05, -0.04, 0.03).dot(axis_map), 0.01);
  EXPECT_LT((error - error.dot(axis_map) * axis_map).norm(), 0.01);
}

INSTANTIATE_TEST_SUITE_P(Yaw, CorridorTest, testing::Values(0.0, 30.0, 45.0, 90.0));

}  // namespace
}  // namespace paloc

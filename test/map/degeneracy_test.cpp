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

// The only face that tells the place along a corridor, some points of a pilaster, a quarter of a
// metre from where the prediction has it. A kernel as narrow as the noise would never see it.
TEST(Degeneracy, FewPointsFarOffTheirPlaneCorrectAnUnsurePrediction) {
  test::BoxWorld world = test::corridor(0.5);
  world.boxes.push_back({Vec3(3.8, 0.4, 0), Vec3(6, 1.2, 2.6)});
  const auto map = PriorMap::build(test::sampleMap(world, 0.1, 0.003, 1), {});
  const Pose truth = world.T_map_world * Pose{Vec3(0.5, 0.2, 1.2), so3::exp(Vec3(0, 0, 0.7))};
  const Vec3 axis_map = world.T_map_world.rotation * Vec3::UnitX();
  const auto matcher = ScanMatcher::onto(map, {});
  int corrected = 0;
  for (unsigned seed = 11; seed < 16; ++seed) {
    const Scan scan = test::simulateScan(world, truth, 12000, {0.02}, 15, seed);
    const Pose guess{truth.position + 0.25 * axis_map, truth.rotation};
    const MapMatch match = matcher->match(scan, toMrpt(guess), 0.13, 0.01);
    ASSERT_TRUE(match.accepted()) << toString(match.refusal);
    const double along = axis_map.dot(fromMrpt(match.T_map_body).position - truth.position);
    if (match.directions[0].cls == DirectionClass::kNone) continue;  // honest, if useless
    EXPECT_LT(std::abs(along), 0.02) << seed;
    ++corrected;
  }
  EXPECT_GE(corrected, 4);
}

// Points that lie on their planes (`agreeing`) and others that do not (`apart`) are all that see x.
DirectionClass classOfX(int agreeing, int apart) {
  std::vector<PlaneRow> rows;
  const auto add = [&rows](const Vec3& normal, const Vec3& point, double robust_weight) {
    PlaneRow row;
    row.normal_body = normal;
    row.point_body = point;
    row.variance = 1e-4 / robust_weight;
    row.robust_weight = robust_weight;
    rows.push_back(row);
  };
  for (int k = 0; k < 2000; ++k) {
    const double u = 0.01 * (k % 100) - 0.5, v = 0.1 * (k / 100) - 1;
    add(k % 2 == 0 ? Vec3::UnitY() : Vec3::UnitZ(), Vec3(4 * u, k % 2 == 0 ? 2 : v, 2 * v), 1);
  }
  for (int k = 0; k < agreeing + apart; ++k) {
    add(Vec3::UnitX(), Vec3(5, 0.1 * (k % 5), 0.1 * (k / 5 % 4)), k < agreeing ? 1.0 : 1e-3);
  }
  const ObservedDirections observed = observeDirections(rows, Mat6::Zero(), 0.01);
  EXPECT_GT(std::abs(observed.directions[0].axis_body.x()), 0.99);
  EXPECT_NEAR(observed.directions[0].agreement, agreeing / (agreeing + apart + 1e-3 * apart), 0.01);
  return observed.directions[0].cls;
}

TEST(Degeneracy, AHandfulOfPointsMustBeOfOneMind) {
  EXPECT_EQ(classOfX(20, 0), DirectionClass::kFull);
  EXPECT_NE(classOfX(20, 25), DirectionClass::kFull);
  EXPECT_EQ(classOfX(400, 400), DirectionClass::kFull) << "hundreds are not wrong together";
}

INSTANTIATE_TEST_SUITE_P(Yaw, CorridorTest, testing::Values(0.0, 30.0, 45.0, 90.0));

}  // namespace
}  // namespace paloc

#include "paloc/core/lidar_odometry_factor.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <numbers>

#include "factor_jacobian_check.h"
#include "random_states.h"

namespace paloc {
namespace {

TEST(LidarOdometryFactor, Jacobians) {
  RandomStates random(1);
  for (int trial = 0; trial < 1000 && !testing::Test::HasFatalFailure(); ++trial) {
    const Pose measured = trial % 2 == 0 ? Pose() : random.pose();
    const LidarOdometryFactor factor(measured, random.covariance(0.1));
    const State i = random.state();
    // The residual, not only the motion, is made tiny or almost half a turn.
    State moved = i;
    moved.T_map_body = i.T_map_body * measured;
    expectJacobiansMatchDifferences(factor, i, random.relatedTo(moved, trial));
  }
}

TEST(LidarOdometryFactor, ResidualByHand) {
  State i, j;  // i looks along y; j is 2 m ahead, looking along -x
  i.T_map_body = {Vec3(1, 1, 0), so3::exp(Vec3(0, 0, std::numbers::pi / 2))};
  j.T_map_body = {Vec3(1, 3, 0), so3::exp(Vec3(0, 0, std::numbers::pi))};
  Mat6 covariance = Mat6::Identity();
  covariance.diagonal() << 0.01, 0.04, 1, 1, 1, 0.25;
  const Pose measured{Vec3(1.5, -1, 0), Mat3::Identity()};
  const auto l = LidarOdometryFactor(measured, covariance).linearize(i, j);
  Eigen::Matrix<double, 6, 1> expected;
  expected << 0.5 / 0.1, 1 / 0.2, 0, 0, 0, std::numbers::pi / 2 / 0.5;
  EXPECT_LT((l.residual - expected).norm(), 1e-12);
}

TEST(LidarOdometryFactor, WhitensByItsCovariance) {
  RandomStates random(2);
  const Mat6 covariance = random.covariance(0.01);
  const State i = random.state();
  State j = i;
  // Where i is not turned and nothing is left over, d residual / d pose j is the whitening itself.
  State plain;
  const auto w = LidarOdometryFactor(Pose(), covariance).linearize(plain, plain);
  const Eigen::Matrix<double, 6, 6> information =
      w.jacobian_j.leftCols<6>().transpose() * w.jacobian_j.leftCols<6>();
  EXPECT_LT((information * covariance - Mat6::Identity()).norm(), 1e-9);

  const Eigen::Matrix<double, 6, 6> root = Eigen::Matrix<double, 6, 6>(covariance).llt().matrixL();
  const Pose motion = random.pose();
  j.T_map_body = i.T_map_body * motion;
  Eigen::Matrix<double, 6, 6> second_moment = Eigen::Matrix<double, 6, 6>::Zero();
  constexpr int kDraws = 20000;
  for (int draw = 0; draw < kDraws; ++draw) {
    Vec6 noise;
    for (int k = 0; k < 6; ++k) noise[k] = random.normal();
    const LidarOdometryFactor factor(boxplus(motion, Vec6(root * noise)), covariance);
    const auto r = factor.linearize(i, j).residual;
    second_moment += r * r.transpose() / kDraws;
  }
  EXPECT_LT((second_moment - Mat6::Identity()).cwiseAbs().maxCoeff(), 0.04);
}

}  // namespace
}  // namespace paloc

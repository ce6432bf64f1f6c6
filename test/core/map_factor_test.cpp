#include "paloc/core/map_factor.h"

#include <gtest/gtest.h>

#include <Eigen/LU>

#include "factor_jacobian_check.h"
#include "random_states.h"

namespace paloc {
namespace {

TEST(MapFactor, Jacobians) {
  RandomStates random(1);
  for (int trial = 0; trial < 1000 && !testing::Test::HasFatalFailure(); ++trial) {
    const State x = random.state();
    const Mat6 information = random.covariance(10);
    const MapFactor factor(random.relatedTo(x, trial).T_map_body, information);
    expectJacobiansMatchDifferences(factor, x);
  }
}

TEST(MapFactor, ResidualByHand) {
  State x;
  x.T_map_body = {Vec3(1, 2, 3), so3::exp(Vec3(0, 0, 0.02))};
  Mat6 information = Mat6::Zero();
  information.diagonal() << 100, 100, 100, 1e4, 1e4, 1e4;
  const auto l = MapFactor({Vec3(1, 2, 2.9), Mat3::Identity()}, information).linearize(x);
  // The rows are those of the information's eigenvectors, so only the norm is fixed.
  EXPECT_NEAR(l.residual.squaredNorm(), 1 + 4, 1e-9);
  const Eigen::Matrix<double, 18, 1> gradient = l.jacobian.transpose() * l.residual;
  EXPECT_NEAR(gradient[tangent::kPosition + 2], 0.1 * 100, 1e-9);
  EXPECT_NEAR(gradient[tangent::kRotation + 2], 0.02 * 1e4, 1e-9);
}

TEST(MapFactor, KeepsItsInformation) {
  RandomStates random(2);
  for (int trial = 0; trial < 50; ++trial) {
    const Mat6 information = random.covariance(100);
    State x = random.state();
    const auto l = MapFactor(x.T_map_body, information).linearize(x);
    const Eigen::Matrix<double, 6, 6> kept =
        l.jacobian.leftCols<6>().transpose() * l.jacobian.leftCols<6>();
    EXPECT_LT((kept - information).norm(), 1e-12 * information.norm());
  }
}

TEST(MapFactor, SaysNothingAlongFreeDirections) {
  RandomStates random(3);
  for (int trial = 0; trial < 50; ++trial) {
    // A corridor in any direction: free along one axis, and in one rotation about another.
    Vec6 free_position = Vec6::Zero(), free_rotation = Vec6::Zero();
    free_position.head<3>() = random.direction();
    free_rotation.tail<3>() = random.direction();
    const Mat6 projector = Mat6::Identity() - free_position * free_position.transpose() -
                           free_rotation * free_rotation.transpose();
    const Mat6 information = projector * random.covariance(200) * projector.transpose();
    const Pose measured = random.pose();
    const MapFactor factor(measured, information);
    State x;
    x.T_map_body = boxplus(measured, Vec6(50 * free_position + 0.5 * free_rotation));
    EXPECT_LT(factor.linearize(x).residual.norm(), 1e-8);
    x.T_map_body = measured;
    const auto l = factor.linearize(x);
    EXPECT_LT((l.jacobian.leftCols<6>() * free_position).norm(), 1e-10);
    int silent_rows = 0;
    for (int row = 0; row < 6; ++row) silent_rows += l.jacobian.row(row).isZero(0) ? 1 : 0;
    EXPECT_EQ(silent_rows, 2);
  }
}

TEST(MapFactor, WithoutInformationIsSilent) {
  RandomStates random(4);
  const auto l = MapFactor(random.pose(), Mat6::Zero()).linearize(random.state());
  EXPECT_TRUE(l.residual.isZero(0));
  EXPECT_TRUE(l.jacobian.isZero(0));
}

}  // namespace
}  // namespace paloc

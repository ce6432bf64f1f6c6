#include "paloc/frontends/lio_filter.h"

#include <gtest/gtest.h>

#include "walls.h"

namespace paloc {
namespace {

ImuBuffer restingImu() {
  ImuBuffer imu;
  for (TimeNs t = 0; t <= kNsPerSecond; t += 5'000'000) {
    imu.add({t, Vec3(0, 0, 9.80665), Vec3::Zero()});
  }
  return imu;
}

LioMatrix somewhatSure(double sigma) { return sigma * sigma * LioMatrix::Identity(); }

TEST(LioFilter, ARoomTellsThePoseAndByItTheVelocity) {
  const ImuBuffer imu = restingImu();
  const test::Walls room({0, 1, 2});
  LioFilter filter({});
  LioState wrong;
  wrong.v_odom = Vec3(0.3, -0.2, 0.1);
  filter.begin(wrong, somewhatSure(0.3));
  constexpr TimeNs kEnd = 100'000'000;
  filter.predict(*imu.integrate(0, kEnd, 0.05, {}, Vec3::Zero(), Vec3::Zero()), {});
  const FreeFallScan scan(imu, kEnd, kEnd, 0.05, Vec3::Zero(), Vec3::Zero());
  EXPECT_GT(filter.update(room.points, scan, Vec3::Zero(), room.map), 1500U);
  EXPECT_LT(filter.state().T_odom_body.position.norm(), 0.003);
  EXPECT_LT(so3::log(filter.state().T_odom_body.rotation).norm(), 0.002);
  const Eigen::VectorXd sigma = filter.covariance().diagonal().cwiseSqrt();
  EXPECT_LT(sigma.head<6>().maxCoeff(), 0.002);
  EXPECT_GT(sigma.head<6>().minCoeff(), 1e-5);
  EXPECT_TRUE(filter.openMotion().isZero());
}

TEST(LioFilter, WhatIsOpenStaysAsItWasPredicted) {
  const ImuBuffer imu = restingImu();
  const test::Walls corridor({1, 2});
  LioFilter filter({});
  filter.begin({}, somewhatSure(0.2));
  constexpr TimeNs kEnd = 100'000'000;
  filter.predict(*imu.integrate(0, kEnd, 0.05, {}, Vec3::Zero(), Vec3::Zero()), {});
  const LioMatrix before = filter.covariance();
  const FreeFallScan scan(imu, kEnd, kEnd, 0.05, Vec3::Zero(), Vec3::Zero());
  EXPECT_TRUE(filter.openMotion().isIdentity()) << "as long as no scan has told";
  filter.update(corridor.points, scan, Vec3::Zero(), corridor.map);
  const Vec6 along_x = Vec6::Unit(0);
  EXPECT_TRUE(filter.openMotion().isApprox(along_x * along_x.transpose(), 0.02));
  const LioMatrix after = filter.covariance();
  EXPECT_GT(after(lio::kPosition, lio::kPosition), 0.98 * before(lio::kPosition, lio::kPosition));
  EXPECT_GT(after(lio::kVelocity, lio::kVelocity), 0.98 * before(lio::kVelocity, lio::kVelocity));
  EXPECT_LT(std::abs(filter.state().T_odom_body.position.x()), 0.01);
  for (int axis = 1; axis < 3; ++axis) EXPECT_LT(std::sqrt(after(axis, axis)), 0.01) << axis;
}

// While a body goes along a corridor, what the IMU made of its errors goes with the way along it.
// Walls tell the rest all the same.
TEST(LioFilter, WhatWentWithAnOpenDirectionIsMeasuredWhole) {
  const ImuBuffer imu = restingImu();
  const test::Walls corridor({1, 2});
  LioMatrix covariance = somewhatSure(0.01);
  LioVector along = LioVector::Zero();
  along[lio::kPosition] = 5;                                   // m, where the others are:
  along.segment<3>(lio::kRotation) = Vec3(0.02, 0.01, -0.02);  // rad
  along[lio::kPosition + 1] = 0.03;                            // m
  covariance += along * along.transpose();
  LioFilter filter({});
  filter.begin({}, covariance);
  constexpr TimeNs kEnd = 100'000'000;
  filter.predict(*imu.integrate(0, kEnd, 0.05, {}, Vec3::Zero(), Vec3::Zero()), {});
  const FreeFallScan scan(imu, kEnd, kEnd, 0.05, Vec3::Zero(), Vec3::Zero());
  filter.update(corridor.points, scan, Vec3::Zero(), corridor.map);
  const LioVector sigma = filter.covariance().diagonal().cwiseSqrt();
  EXPECT_GT(sigma[lio::kPosition], 4.9);
  EXPECT_LT(sigma.segment<2>(lio::kPosition + 1).maxCoeff(), 0.005);
  EXPECT_LT(sigma.segment<3>(lio::kRotation).maxCoeff(), 0.002);
}

// Of an update that knows nothing, the motion's covariance is that of the prediction: errors that
// both poses share cancel.
TEST(LioFilter, TheMotionsCovarianceLeavesOutWhatBothPosesShare) {
  const ImuBuffer imu = restingImu();
  LioFilter filter({});
  LioMatrix covariance = LioMatrix::Zero();
  covariance.diagonal().head<3>().setConstant(4.0);  // position, m2
  covariance.diagonal().segment<3>(lio::kVelocity).setConstant(0.01);
  filter.begin({}, covariance);
  filter.predict(*imu.integrate(0, 100'000'000, 0.05, {}, Vec3::Zero(), Vec3::Zero()), {});
  const Mat6 motion = filter.motionCovariance();
  for (int axis = 0; axis < 3; ++axis) {
    EXPECT_NEAR(std::sqrt(motion(axis, axis)), 0.1 * 0.1, 2e-4) << "speed times time";
  }
}

}  // namespace
}  // namespace paloc

#include "paloc/frontends/icp_filter.h"

#include <gtest/gtest.h>

#include "walls.h"

namespace paloc {
namespace {

constexpr double kDt = 0.1;  // s

ChordMatrix sure(double velocity_mps, double rate_radps) {
  ChordVector sigma;
  sigma << Vec6::Zero(), Vec3::Constant(velocity_mps), Vec3::Constant(rate_radps), Vec6::Zero();
  return sigma.cwiseAbs2().asDiagonal();
}

/// What a body that moves like this from the origin, over kDt, measures of points that are seen
/// from its end; each at an age of its own.
std::vector<MeasuredPoint> seenInMotion(const std::vector<MeasuredPoint>& points,
                                        const ChordMotion& end) {
  std::vector<MeasuredPoint> measured;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double age_s =
        kDt * static_cast<double>((7 * i) % points.size()) / static_cast<double>(points.size());
    measured.push_back({end.before(age_s).inverse() * points[i].point_body, age_s});
  }
  return measured;
}

TEST(IcpFilter, FindsVelocitiesInTheDistortionOfOneScan) {
  const test::Walls room({0, 1, 2});
  ChordMotion start;
  start.v_odom = Vec3(1.2, -0.7, 0.2);
  start.omega_body = Vec3(0.3, -0.2, 1.1);
  const ChordMotion end = continued(start, kDt);
  IcpFilter filter({}, {});
  filter.begin({}, sure(1.5, 1));
  filter.predict(kDt);
  const auto points = seenInMotion(room.points, end);
  EXPECT_GT(filter.update(points, Vec3::Zero(), room.map), 1500U);
  const ChordVector error = boxminus(filter.state(), end);
  EXPECT_LT(error.head<3>().norm(), 0.003) << "m";
  EXPECT_LT(error.segment<3>(chord::kRotation).norm(), 0.002) << "rad";
  EXPECT_LT(error.segment<3>(chord::kVelocity).norm(), 0.04) << "m/s";
  EXPECT_LT(error.segment<3>(chord::kRate).norm(), 0.02) << "rad/s";
  const double normalized = error.dot(filter.covariance().ldlt().solve(error));
  EXPECT_LT(normalized, 50) << "of 18 degrees of freedom";
}

TEST(IcpFilter, TakesAnUpdateBack) {
  const test::Walls room({0, 1, 2});
  ChordMotion start;
  start.v_odom = Vec3(1, 0, 0);
  IcpFilter filter({}, {});
  filter.begin({}, sure(1.5, 1));
  filter.predict(kDt);
  const ChordMotion predicted = filter.state();
  const ChordMatrix covariance = filter.covariance();
  const Mat6 of_motion = filter.motionCovariance();
  const auto points = seenInMotion(room.points, continued(start, kDt));
  filter.update(points, Vec3::Zero(), room.map);
  const ChordMotion found = filter.state();
  EXPECT_GT(boxminus(found, predicted).norm(), 0.05);
  filter.takeBack();
  EXPECT_EQ(boxminus(filter.state(), predicted).norm(), 0);
  EXPECT_EQ(filter.covariance(), covariance);
  EXPECT_EQ(filter.motionCovariance(), of_motion);
  filter.update(points, Vec3::Zero(), room.map);
  EXPECT_LT(boxminus(filter.state(), found).norm(), 1e-15);
}

TEST(IcpFilter, FindsTheBendOfTheWay) {
  const test::Walls room({0, 1, 2}, 3.1);  // not where voxels meet
  ChordMotion end;
  end.duration_s = kDt;
  end.acceleration_odom = Vec3(3, -2, 0);
  end.angular_acceleration_body = Vec3(0, 0, 2.5);
  IcpFilter filter({}, {5, 5});
  filter.begin({}, sure(0.1, 0.1));
  filter.predict(kDt);
  filter.update(seenInMotion(room.points, end), Vec3::Zero(), room.map);
  EXPECT_LT((filter.state().acceleration_odom - end.acceleration_odom).norm(), 2) << "m/s2";
  EXPECT_LT(filter.state().T_odom_body.position.norm(), 0.003);
}

TEST(IcpFilter, WhatIsOpenGoesOnAsItWas) {
  const test::Walls corridor({1, 2});
  ChordMotion start;
  start.v_odom = Vec3(1, 0, 0);
  IcpFilter filter({}, {});
  ChordMatrix covariance = sure(0.3, 0.3);
  filter.begin(start, covariance);
  filter.predict(kDt);
  const ChordMatrix before = filter.covariance();
  EXPECT_TRUE(filter.openMotion().isIdentity()) << "as long as no scan has told";
  filter.update(seenInMotion(corridor.points, continued(start, kDt)), Vec3::Zero(), corridor.map);
  const Vec6 along_x = Vec6::Unit(0);
  EXPECT_TRUE(filter.openMotion().isApprox(along_x * along_x.transpose(), 0.02));
  const ChordMatrix after = filter.covariance();
  EXPECT_NEAR(filter.state().T_odom_body.position.x(), 0.1, 0.01);
  EXPECT_GT(after(chord::kPosition, chord::kPosition), 0.98 * before(0, 0));
  EXPECT_GT(after(chord::kVelocity, chord::kVelocity), 0.98 * before(6, 6));
  for (int axis = 1; axis < 3; ++axis) EXPECT_LT(std::sqrt(after(axis, axis)), 0.01) << axis;
}

TEST(IcpFilter, TheMotionsCovarianceIsThatOfTheVelocityWhereNothingIsSeen) {
  IcpFilter filter({}, {0, 0});
  ChordMatrix covariance = sure(0.2, 0.1);
  covariance.diagonal().head<3>().setConstant(9);  // of both poses alike
  filter.begin({}, covariance);
  filter.predict(kDt);
  const Mat6 motion = filter.motionCovariance();
  for (int axis = 0; axis < 3; ++axis) {
    EXPECT_NEAR(std::sqrt(motion(axis, axis)), 0.2 * kDt, 1e-6);
    EXPECT_NEAR(std::sqrt(motion(3 + axis, 3 + axis)), 0.1 * kDt, 1e-9);
  }
}

}  // namespace
}  // namespace paloc

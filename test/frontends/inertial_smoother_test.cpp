#include "paloc/frontends/inertial_smoother.h"

#include <gtest/gtest.h>

#include "paloc/frontends/lio_filter.h"
#include "smooth_motion.h"
#include "walls.h"

namespace paloc {
namespace {

constexpr TimeNs kScan = 100'000'000;

ImuBuffer imuOf(const test::SmoothMotion& motion, double until_s) {
  ImuBuffer imu;
  for (int i = 0; i <= static_cast<int>(until_s * 400) + 1; ++i) imu.add(motion.imu(i / 400.0));
  return imu;
}

LioState stateOf(const test::SmoothMotion& motion, double t_s) {
  LioState x;
  x.T_odom_body = motion.pose(t_s);
  x.v_odom = motion.velocity(t_s);
  x.gravity_odom = Vec3(0, 0, -motion.gravity_mps2);
  return x;
}

/// The walls' map, as that of key frames.
KeyFrameMap keyFramesOf(const test::Walls& walls) {
  KeyFrameMap map({});
  std::vector<PlacedPoint> placed;
  for (const Vec3& p : walls.map_points) placed.push_back({p, p, p, 0});
  map.add(placed, {});
  return map;
}

/// A scan that fixes the pose to `sigma` (m, rad) at a state, and no velocity.
FeatureMeasurement poseMeasured(const LioState& at, double sigma) {
  FeatureMeasurement measured;
  measured.found = at;
  measured.information.topLeftCorner<6, 6>() =
      1 / (sigma * sigma) * Eigen::Matrix<double, 6, 6>::Identity();
  return measured;
}

class InertialSmootherTest : public testing::Test {
 protected:
  void step(int scan, const FeatureMeasurement& measured, const Vec9& blur = Vec9::Zero()) {
    const LioState& x = smoother_.state();
    smoother_.predict(
        *imu_.integrate((scan - 1) * kScan, scan * kScan, 0.05, {}, x.bias_acc, x.bias_gyro), {});
    smoother_.add(scan * kScan, measured, blur, true);
  }

  test::SmoothMotion motion_ = [] {
    test::SmoothMotion motion;
    motion.bias_acc = Vec3(0.05, -0.04, 0.03);
    motion.bias_gyro = Vec3(0.004, -0.003, 0.005);
    return motion;
  }();
  ImuBuffer imu_ = imuOf(motion_, 6.1);
  InertialSmoother smoother_{2, motion_.gravity_mps2};
};

TEST_F(InertialSmootherTest, PosesTellVelocityBiasesAndWhereGravityPoints) {
  LioState first = stateOf(motion_, 0);
  first.v_odom = Vec3::Zero();
  first.gravity_odom = so3::exp(Vec3(0.05, -0.08, 0)) * first.gravity_odom;
  smoother_.begin(0, first, {});
  for (int i = 1; i <= 60; ++i) step(i, poseMeasured(stateOf(motion_, 0.1 * i), 5e-4));
  const LioState& x = smoother_.state();
  EXPECT_LT((x.v_odom - motion_.velocity(6)).norm(), 0.01);
  EXPECT_LT((x.bias_gyro - motion_.bias_gyro).norm(), 3e-4);
  EXPECT_LT((x.bias_acc - motion_.bias_acc).norm(), 0.03);
  EXPECT_LT(x.gravity_odom.normalized().cross(Vec3::UnitZ()).norm(), 0.003);
  EXPECT_NEAR(x.gravity_odom.norm(), motion_.gravity_mps2, 1e-9);
  EXPECT_FALSE(smoother_.smoothed(0)) << "it has left the window";
  const auto before = smoother_.smoothed(50 * kScan);
  ASSERT_TRUE(before);
  EXPECT_LT((before->v_odom - motion_.velocity(5)).norm(), 0.01);
}

TEST_F(InertialSmootherTest, WhatAScanLeavesOpenIsCarriedByTheImuAndUncertain) {
  smoother_.begin(0, stateOf(motion_, 0), {.sigma_velocity_mps = 0.1});
  for (int i = 1; i <= 20; ++i) step(i, poseMeasured(stateOf(motion_, 0.1 * i), 5e-4));
  const double sigma_known = std::sqrt(smoother_.motionCovariance()(0, 0));
  for (int i = 21; i <= 40; ++i) {
    FeatureMeasurement measured = poseMeasured(stateOf(motion_, 0.1 * i), 5e-4);
    measured.information(0, 0) = 0;  // odom x
    step(i, measured);
  }
  const Mat3 R_0 = motion_.rotation(3.9);
  const Mat3 position = R_0 * smoother_.motionCovariance().topLeftCorner<3, 3>() * R_0.transpose();
  EXPECT_LT(std::sqrt(position(1, 1)), 2 * sigma_known);
  EXPECT_GT(std::sqrt(position(0, 0)), 1e-5);
  const double error =
      std::abs(smoother_.state().T_odom_body.position.x() - motion_.position(4).x());
  EXPECT_LT(error, 0.1) << "two seconds of dead reckoning";
}

/// How unsure the motion is after two seconds in a tunnel along x, whose axis each scan takes to be
/// a tenth of a degree to the one or to the other side (m); `told`: the scans say what is open.
double sigmaInATunnel(const test::SmoothMotion& motion, const ImuBuffer& imu, bool told) {
  InertialSmoother smoother(2, motion.gravity_mps2);
  smoother.begin(0, stateOf(motion, 0), {.sigma_velocity_mps = 0.5});
  for (int i = 1; i <= 20; ++i) {
    const LioState& x = smoother.state();
    smoother.predict(*imu.integrate((i - 1) * kScan, i * kScan, 0.05, {}, x.bias_acc, x.bias_gyro),
                     {});
    FeatureMeasurement measured = poseMeasured(stateOf(motion, 0.1 * i), 5e-4);
    const Vec3 axis = Vec3(1, i % 2 == 0 ? 0.002 : -0.002, 0).normalized();
    measured.information.topLeftCorner<3, 3>() -=
        measured.information(0, 0) * axis * axis.transpose();
    if (told) {
      measured.open = NullDirections<9>::Zero(9, 2);
      measured.open.col(0).head<3>() = axis;
      measured.open.col(1).tail<3>() = axis;
    }
    smoother.add(i * kScan, measured, Vec9::Zero(), false);
  }
  return std::sqrt(smoother.motionCovariance().topLeftCorner<3, 3>().trace());
}

TEST_F(InertialSmootherTest, TellsWhatOfTheMotionIsTheImus) {
  smoother_.begin(0, stateOf(motion_, 0), {.sigma_velocity_mps = 0.1});
  step(1, poseMeasured(stateOf(motion_, 0.1), 5e-4));
  EXPECT_TRUE(smoother_.openMotion().isZero());
  const Mat3 R_before = smoother_.state().T_odom_body.rotation;
  FeatureMeasurement measured = poseMeasured(stateOf(motion_, 0.2), 5e-4);
  measured.information(0, 0) = 0;  // odom x
  measured.open = NullDirections<9>::Zero(9, 2);
  measured.open.col(0).head<3>() = measured.open.col(1).tail<3>() = Vec3::UnitX();
  step(2, measured);
  Vec6 along_x = Vec6::Zero();  // in the body frame of the node before
  along_x.head<3>() = R_before.transpose() * Vec3::UnitX();
  EXPECT_TRUE(smoother_.openMotion().isApprox(along_x * along_x.transpose(), 1e-3));
}

TEST_F(InertialSmootherTest, AnOpenDirectionThatWaversDoesNotTieThePositionDown) {
  const double told = sigmaInATunnel(motion_, imu_, true);
  const double not_told = sigmaInATunnel(motion_, imu_, false);
  EXPECT_GT(told, 0.8 * 0.5 * 0.1) << "the first velocity's, over a tenth of a second";
  EXPECT_LT(not_told, 0.5 * told);
}

// A corridor along x, standing still: what the scans tell of the tilt goes with how far the body
// has moved along it. The filter and the smoother are told the same.
TEST(InertialSmootherInACorridor, BelievesWhatTheFiltersUpdateBelieves) {
  ImuBuffer imu;
  for (TimeNs t = 0; t <= 3 * kNsPerSecond; t += 5'000'000) {
    imu.add({t, Vec3(0, 0, 9.80665), Vec3::Zero()});
  }
  const test::Walls corridor({1, 2});
  // So sure of the tilt that a step of gravity is small: it is added to a node's, and turns the
  // filter's, and these part at third order.
  const InertialStart start{.sigma_velocity_mps = 0.3, .sigma_acceleration_mps2 = 0.3};
  InertialSmoother smoother(2, 9.80665);
  smoother.begin(0, {}, start);
  FeatureRegistration registration({});
  const KeyFrameMap map = keyFramesOf(corridor);
  const ScanFeatures features{corridor.points, {}};
  for (int i = 1; i <= 25; ++i) {
    const auto motion =
        imu.integrate((i - 1) * kScan, i * kScan, 0.05, {}, Vec3::Zero(), Vec3::Zero());
    smoother.predict(*motion, {});
    const FreeFallScan scan(imu, i * kScan, i * kScan, 0.05, Vec3::Zero(), Vec3::Zero());
    LioFilter filter({});
    filter.begin(smoother.predicted(), smoother.predictedCovariance());
    filter.update(corridor.points, scan, Vec3::Zero(), map.planes());
    const FeatureMeasurement measured = registration.align(
        features, scan, Vec3::Zero(), map, smoother.predicted(), smoother.predictedCovariance());
    EXPECT_EQ(measured.open.cols(), 2) << "position and velocity along the corridor";
    smoother.add(i * kScan, measured, Vec9::Zero(), false);
    EXPECT_LT(boxminus(smoother.state(), filter.state()).norm(), 1e-7) << i;
    const LioVector scale = filter.covariance().diagonal().cwiseSqrt().cwiseInverse();
    const LioMatrix more = smoother.covariance() - filter.covariance();
    EXPECT_LT((scale.asDiagonal() * more * scale.asDiagonal()).cwiseAbs().maxCoeff(), 1e-4) << i;
  }
}

// Between two scans that know nothing of each other's pose, the motion is as unsure as both.
TEST_F(InertialSmootherTest, TheMotionsCovarianceIsThatOfItsEnds) {
  ImuNoise blind;
  blind.accelerometer_noise_density_mps2_sqrthz = 100;
  blind.gyroscope_noise_density_radps_sqrthz = 100;
  smoother_.begin(0, stateOf(motion_, 0), {});
  for (int i = 1; i <= 3; ++i) {
    smoother_.predict(
        *imu_.integrate((i - 1) * kScan, i * kScan, 0.05, blind, Vec3::Zero(), Vec3::Zero()),
        blind);
    smoother_.add(i * kScan, poseMeasured(stateOf(motion_, 0.1 * i), 0.01), Vec9::Zero(), false);
  }
  const Mat6 covariance = smoother_.motionCovariance();
  for (int axis = 0; axis < 6; ++axis) {
    EXPECT_NEAR(std::sqrt(covariance(axis, axis)), std::sqrt(2.0) * 0.01, 5e-4) << axis;
  }
}

TEST_F(InertialSmootherTest, ABlurredScanSaysLess) {
  InertialSmoother sharp(2, motion_.gravity_mps2);
  const LioState off = boxplus(stateOf(motion_, 0.1), LioVector::Unit(lio::kPosition) * 0.01);
  const auto begin = [&](InertialSmoother& smoother) {
    smoother.begin(0, stateOf(motion_, 0), {});
    smoother.predict(*imu_.integrate(0, kScan, 0.05, {}, Vec3::Zero(), Vec3::Zero()), {});
  };
  begin(smoother_);
  begin(sharp);
  sharp.add(kScan, poseMeasured(off, 0.01), Vec9::Zero(), false);
  smoother_.add(kScan, poseMeasured(off, 0.01), Vec9::Constant(0.09), false);
  const double truth = motion_.position(0.1).x();
  EXPECT_NEAR(sharp.state().T_odom_body.position.x() - truth, 0.01, 0.001);
  EXPECT_LT(smoother_.motionCovariance()(0, 0), 0.1);
  EXPECT_GT(smoother_.motionCovariance()(0, 0), 10 * sharp.motionCovariance()(0, 0));
}

TEST_F(InertialSmootherTest, IsLostWhereNothingHoldsIt) {
  smoother_.begin(0, stateOf(motion_, 0), {.sigma_velocity_mps = 90});
  EXPECT_FALSE(smoother_.isLost());
  FeatureMeasurement nothing;
  for (int i = 1; i <= 20 && !smoother_.isLost(); ++i) {
    nothing.found = stateOf(motion_, 0.1 * i);
    step(i, nothing);
  }
  EXPECT_TRUE(smoother_.isLost());
}

}  // namespace
}  // namespace paloc

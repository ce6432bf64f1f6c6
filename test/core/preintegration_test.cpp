#include "paloc/core/preintegration.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <limits>
#include <vector>

#include "random_states.h"

namespace paloc {
namespace {

struct Step {
  Vec3 acc, omega;
  double dt_s;
};

std::vector<Step> randomSteps(RandomStates& random, int count) {
  std::vector<Step> steps;
  for (int k = 0; k < count; ++k) {
    steps.push_back(
        {Vec3(1, 2, 9.81) + random.vector(3), random.vector(1.5), random.uniform(0.001, 0.02)});
  }
  return steps;
}

Preintegration integrated(const std::vector<Step>& steps, const Vec3& bias_acc = Vec3::Zero(),
                          const Vec3& bias_gyro = Vec3::Zero()) {
  Preintegration p(ImuNoise(), bias_acc, bias_gyro);
  for (const Step& s : steps) p.integrate(s.acc, s.omega, s.dt_s);
  return p;
}

TEST(Preintegration, EqualsDenseIntegration) {
  RandomStates random(1);
  const std::vector<Step> steps = randomSteps(random, 40);
  Mat3 R = Mat3::Identity();
  Vec3 v = Vec3::Zero(), p = Vec3::Zero();
  constexpr int kParts = 1000;
  for (const Step& s : steps) {
    const double h = s.dt_s / kParts;
    const Mat3 half = so3::exp(0.5 * h * s.omega);
    for (int part = 0; part < kParts; ++part) {  // the midpoint rule: its error falls with h^2
      const Vec3 a = R * half * s.acc;
      p += v * h + 0.5 * h * h * a;
      v += a * h;
      R = R * half * half;
    }
  }
  const Preintegration fast = integrated(steps);
  EXPECT_LT((fast.delta_p - p).norm(), 1e-9);
  EXPECT_LT((fast.delta_v - v).norm(), 1e-8);
  EXPECT_LT(so3::log(fast.delta_R.transpose() * R).norm(), 1e-10);
}

TEST(Preintegration, BiasJacobiansEqualReintegration) {
  RandomStates random(2);
  for (int trial = 0; trial < 50; ++trial) {
    const std::vector<Step> steps = randomSteps(random, 20);
    const Vec3 bias_acc = random.vector(0.1), bias_gyro = random.vector(0.05);
    const Preintegration here = integrated(steps, bias_acc, bias_gyro);
    constexpr double kStep = 1e-5;
    for (int k = 0; k < 3; ++k) {
      const Vec3 d = kStep * Vec3::Unit(k);
      const Preintegration acc_up = integrated(steps, bias_acc + d, bias_gyro);
      const Preintegration acc_down = integrated(steps, bias_acc - d, bias_gyro);
      const Preintegration gyro_up = integrated(steps, bias_acc, bias_gyro + d);
      const Preintegration gyro_down = integrated(steps, bias_acc, bias_gyro - d);
      const auto slope = [](const Vec3& up, const Vec3& down) { return (up - down) / (2 * kStep); };
      const Vec3 rotation_slope = slope(so3::log(here.delta_R.transpose() * gyro_up.delta_R),
                                        so3::log(here.delta_R.transpose() * gyro_down.delta_R));
      EXPECT_LT((here.dp_dbias_acc.col(k) - slope(acc_up.delta_p, acc_down.delta_p)).norm(), 1e-8);
      EXPECT_LT((here.dv_dbias_acc.col(k) - slope(acc_up.delta_v, acc_down.delta_v)).norm(), 1e-8);
      EXPECT_LT((here.dR_dbias_gyro.col(k) - rotation_slope).norm(), 1e-8);
      // These are expanded to first order in the turn within a step (here up to 50 mrad).
      EXPECT_LT((here.dp_dbias_gyro.col(k) - slope(gyro_up.delta_p, gyro_down.delta_p)).norm(),
                1e-4 * here.dp_dbias_gyro.norm());
      EXPECT_LT((here.dv_dbias_gyro.col(k) - slope(gyro_up.delta_v, gyro_down.delta_v)).norm(),
                1e-4 * here.dv_dbias_gyro.norm());
    }
  }
}

TEST(Preintegration, DuplicatesAndStepsBackwardsChangeNothing) {
  RandomStates random(3);
  Preintegration p = integrated(randomSteps(random, 10));
  const Preintegration before = p;
  for (const double dt : {0.0, -0.01, std::numeric_limits<double>::quiet_NaN()}) {
    p.integrate(random.vector(10), random.vector(), dt);
  }
  EXPECT_EQ(p.dt_s, before.dt_s);
  EXPECT_EQ(p.delta_p, before.delta_p);
  EXPECT_EQ(p.delta_R, before.delta_R);
  EXPECT_EQ(p.delta_v, before.delta_v);
  EXPECT_EQ(p.covariance, before.covariance);
  EXPECT_EQ(p.dp_dbias_gyro, before.dp_dbias_gyro);
}

TEST(Preintegration, UnevenStepsOfOneSignalAgree) {
  // A constant signal cut into any steps is the same motion, with the same uncertainty.
  RandomStates random(4);
  const Vec3 acc(0.5, -1, 9.7), omega(0.4, 0.2, -0.8);
  Preintegration fine(ImuNoise(), Vec3::Zero(), Vec3::Zero()), uneven = fine;
  for (int k = 0; k < 200; ++k) fine.integrate(acc, omega, 0.001);
  double left = 0.2;
  while (left > 0.004) {
    const double dt = std::min(left, random.uniform(0.001, 0.02));
    uneven.integrate(acc, omega, dt);
    left -= dt;
  }
  uneven.integrate(acc, omega, left);
  EXPECT_NEAR(uneven.dt_s, fine.dt_s, 1e-12);
  EXPECT_LT((uneven.delta_p - fine.delta_p).norm(), 1e-8);
  EXPECT_LT((uneven.delta_v - fine.delta_v).norm(), 1e-7);
  EXPECT_LT((uneven.covariance - fine.covariance).norm(), 0.01 * fine.covariance.norm());
}

TEST(Preintegration, OneStepLeavesAPositiveDefiniteCovariance) {
  for (const double dt : {1e-4, 0.005, 0.1}) {
    Preintegration p(ImuNoise(), Vec3::Zero(), Vec3::Zero());
    p.integrate(Vec3(1, 2, 9.81), Vec3(0.3, 0.2, -1), dt);
    // Scaled to correlations, so that seconds and radians do not hide a singular matrix.
    const Eigen::Matrix<double, 9, 1> scale = p.covariance.diagonal().cwiseSqrt().cwiseInverse();
    const Preintegration::Covariance correlation =
        scale.asDiagonal() * p.covariance * scale.asDiagonal();
    const Eigen::SelfAdjointEigenSolver<Preintegration::Covariance> eigen(correlation);
    EXPECT_GT(eigen.eigenvalues()[0], 1e-3) << dt;
  }
}

TEST(Preintegration, CovarianceEqualsMonteCarlo) {
  RandomStates random(5);
  ImuNoise noise;
  noise.accelerometer_noise_density_mps2_sqrthz = 0.01;
  noise.gyroscope_noise_density_radps_sqrthz = 2e-3;
  constexpr double kDt_s = 0.005;
  constexpr int kDraws = 5000;
  std::vector<Step> steps = randomSteps(random, 40);
  for (Step& s : steps) s.dt_s = kDt_s;
  Preintegration mean(noise, Vec3::Zero(), Vec3::Zero());
  for (const Step& s : steps) mean.integrate(s.acc, s.omega, s.dt_s);
  Preintegration::Covariance sampled = Preintegration::Covariance::Zero();
  for (int draw = 0; draw < kDraws; ++draw) {
    Preintegration p(noise, Vec3::Zero(), Vec3::Zero());
    for (const Step& s : steps) {
      p.integrate(s.acc + random.vector(0.01 / std::sqrt(kDt_s)),
                  s.omega + random.vector(2e-3 / std::sqrt(kDt_s)), s.dt_s);
    }
    Eigen::Matrix<double, 9, 1> error;
    error << p.delta_p - mean.delta_p, so3::log(mean.delta_R.transpose() * p.delta_R),
        p.delta_v - mean.delta_v;
    sampled += error * error.transpose() / kDraws;
  }
  const Eigen::Matrix<double, 9, 1> scale = mean.covariance.diagonal().cwiseSqrt().cwiseInverse();
  const Preintegration::Covariance difference =
      scale.asDiagonal() * (sampled - mean.covariance) * scale.asDiagonal();
  EXPECT_LT(difference.cwiseAbs().maxCoeff(), 0.08) << difference;
}

}  // namespace
}  // namespace paloc

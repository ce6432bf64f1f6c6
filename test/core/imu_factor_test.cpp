#include "paloc/core/imu_factor.h"

#include <gtest/gtest.h>

#include "factor_jacobian_check.h"
#include "random_states.h"

namespace paloc {
namespace {

constexpr double kGravity_mps2 = 9.81;

Preintegration randomMotion(RandomStates& random, int samples = 20) {
  Preintegration p(ImuNoise(), random.vector(0.1), random.vector(0.02));
  const Vec3 acc = random.vector(10), omega = random.vector(2);
  for (int k = 0; k < samples; ++k) {
    p.integrate(acc + random.vector(), omega + random.vector(0.3), random.uniform(0.002, 0.01));
  }
  return p;
}

TEST(ImuFactor, Jacobians) {
  RandomStates random(1);
  for (int trial = 0; trial < 1000 && !testing::Test::HasFatalFailure(); ++trial) {
    const ImuFactor factor(randomMotion(random), kGravity_mps2);
    const State i = random.state();
    expectJacobiansMatchDifferences(factor, i, random.relatedTo(factor.predict(i), trial));
  }
}

TEST(ImuFactor, PredictionHasNoResidual) {
  RandomStates random(2);
  for (int trial = 0; trial < 100; ++trial) {
    const ImuFactor factor(randomMotion(random), kGravity_mps2);
    const State i = random.state();
    // Whitened by micrometres and microradians: rounding shows.
    EXPECT_LT(factor.linearize(i, factor.predict(i)).residual.norm(), 1e-7);
  }
}

TEST(ImuFactor, ByHand) {
  // One second at rest, then compared with a body that fell freely and one that moved on.
  Preintegration p(ImuNoise(), Vec3::Zero(), Vec3::Zero());
  for (int k = 0; k < 100; ++k) p.integrate(Vec3(0, 0, kGravity_mps2), Vec3::Zero(), 0.01);
  const ImuFactor factor(p, kGravity_mps2);
  State i, j;
  EXPECT_LT(factor.linearize(i, j).residual.norm(), 1e-7);
  i.v_map = Vec3(2, 0, 0);
  const State moved = factor.predict(i);
  EXPECT_LT((moved.T_map_body.position - Vec3(2, 0, 0)).norm(), 1e-12);
  EXPECT_LT((moved.v_map - Vec3(2, 0, 0)).norm(), 1e-12);

  // Gravity taken 1 degree off: the body seems to slide by g sin(1 deg) t^2 / 2.
  State tilted;
  tilted.gravity_map = so3::exp(Vec3(0, 0.0174533, 0)) * -Vec3::UnitZ();
  const State slid = factor.predict(tilted);
  EXPECT_NEAR(slid.T_map_body.position.x(), -0.5 * kGravity_mps2 * std::sin(0.0174533), 1e-9);
}

TEST(ImuFactor, WhitensWhatTheNoiseDoes) {
  RandomStates random(3);
  ImuNoise noise;
  noise.accelerometer_noise_density_mps2_sqrthz = 2e-3;
  noise.gyroscope_noise_density_radps_sqrthz = 1e-3;
  constexpr int kSamples = 20, kDraws = 6000;
  constexpr double kDt_s = 0.005;
  std::vector<Vec3> acc, omega;
  for (int k = 0; k < kSamples; ++k) {
    acc.push_back(Vec3(0, 0, kGravity_mps2) + random.vector(2));
    omega.push_back(Vec3(0.3, -0.5, 1) + random.vector(0.2));
  }
  const auto integrate = [&](double noise_scale) {
    Preintegration p(noise, Vec3::Zero(), Vec3::Zero());
    const double acc_sigma = noise_scale * noise.accelerometer_noise_density_mps2_sqrthz;
    const double gyro_sigma = noise_scale * noise.gyroscope_noise_density_radps_sqrthz;
    for (int k = 0; k < kSamples; ++k) {
      p.integrate(acc[static_cast<std::size_t>(k)] + random.vector(acc_sigma / std::sqrt(kDt_s)),
                  omega[static_cast<std::size_t>(k)] + random.vector(gyro_sigma / std::sqrt(kDt_s)),
                  kDt_s);
    }
    return p;
  };
  const State i = random.state();
  State at_bias = i;
  at_bias.bias_acc.setZero();
  at_bias.bias_gyro.setZero();
  const State j = ImuFactor(integrate(0), kGravity_mps2).predict(at_bias);
  Eigen::Matrix<double, 9, 9> second_moment = Eigen::Matrix<double, 9, 9>::Zero();
  for (int draw = 0; draw < kDraws; ++draw) {
    const auto r = ImuFactor(integrate(1), kGravity_mps2).linearize(at_bias, j).residual;
    second_moment += r * r.transpose() / kDraws;
  }
  using Identity = Eigen::Matrix<double, 9, 9>;
  EXPECT_LT((second_moment - Identity::Identity()).cwiseAbs().maxCoeff(), 0.08) << second_moment;
}

}  // namespace
}  // namespace paloc

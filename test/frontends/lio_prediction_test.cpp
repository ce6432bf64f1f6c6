#include "paloc/frontends/lio_prediction.h"

#include <gtest/gtest.h>

#include <random>

namespace paloc {
namespace {

/// A tenth of a second of an IMU that turns and is shaken, integrated with the biases of a state.
Preintegration integrate(const std::vector<Vec3>& force, const std::vector<Vec3>& rate,
                         const LioState& x) {
  Preintegration imu({}, x.bias_acc, x.bias_gyro);
  for (std::size_t i = 0; i < force.size(); ++i) imu.integrate(force[i], rate[i], 0.005);
  return imu;
}

TEST(LioPrediction, TransitionIsTheDerivative) {
  std::mt19937_64 random(5);
  std::normal_distribution<double> normal;
  const auto vector = [&] { return Vec3(normal(random), normal(random), normal(random)); };
  for (int trial = 0; trial < 1000; ++trial) {
    std::vector<Vec3> force, rate;
    for (int i = 0; i < 20; ++i) {
      force.push_back(Vec3(0, 0, 9.8) + 3 * vector());
      rate.push_back(1.5 * vector());
    }
    LioState x;
    x.T_odom_body = {vector(), so3::exp(2 * vector())};
    x.v_odom = vector();
    x.bias_acc = 0.1 * vector();
    x.bias_gyro = 0.01 * vector();
    x.gravity_odom = so3::exp(0.3 * vector()) * x.gravity_odom;
    const Preintegration imu = integrate(force, rate, x);
    const LioState y = predictLio(x, imu);
    const LioMatrix F = lioTransition(x, imu);
    constexpr double kStep = 1e-5;
    for (int k = 0; k < lio::kDim; ++k) {
      const auto moved = [&](double step) {
        const LioState other = boxplus(x, step * LioVector::Unit(k));
        return boxminus(predictLio(other, integrate(force, rate, other)), y);
      };
      const LioVector numeric = (moved(kStep) - moved(-kStep)) / (2 * kStep);
      EXPECT_LT((F.col(k) - numeric).cwiseAbs().maxCoeff(), 2e-6) << "column " << k;
    }
  }
}

TEST(LioPrediction, NoiseIsThatOfManySamples) {
  constexpr double kForce = 0.02, kRate = 0.004;  // densities
  ImuNoise noise;
  noise.accelerometer_noise_density_mps2_sqrthz = kForce;
  noise.gyroscope_noise_density_radps_sqrthz = kRate;
  LioState x;
  x.T_odom_body.rotation = so3::exp(Vec3(0.3, -0.8, 1.2));
  const Vec3 force(1, 2, 9), rate(0.3, -0.2, 1);
  constexpr double kDt = 0.005;
  const auto run = [&](const auto& disturb) {
    Preintegration imu(noise, x.bias_acc, x.bias_gyro);
    for (int i = 0; i < 20; ++i) {
      imu.integrate(force + disturb(kForce), rate + disturb(kRate), kDt);
    }
    return imu;
  };
  const Preintegration exact = run([](double) { return Vec3(Vec3::Zero()); });
  const LioState expected = predictLio(x, exact);
  std::mt19937_64 random(6);
  std::normal_distribution<double> normal;
  LioMatrix sampled = LioMatrix::Zero();
  constexpr int kRuns = 20000;
  for (int i = 0; i < kRuns; ++i) {
    const auto disturb = [&](double density) -> Vec3 {
      return density / std::sqrt(kDt) * Vec3(normal(random), normal(random), normal(random));
    };
    const LioVector error = boxminus(predictLio(x, run(disturb)), expected);
    sampled += error * error.transpose() / kRuns;
  }
  const LioMatrix Q = lioProcessNoise(x, exact, noise);
  for (int i = 0; i < 9; ++i) {
    for (int j = 0; j < 9; ++j) {
      const double scale = std::sqrt(Q(i, i) * Q(j, j));
      EXPECT_NEAR(sampled(i, j) / scale, Q(i, j) / scale, 0.04) << i << ", " << j;
    }
  }
  const double walk = noise.accelerometer_bias_walk_mps3_sqrthz;
  EXPECT_NEAR(Q(lio::kBiasAcc, lio::kBiasAcc), walk * walk * exact.dt_s, 1e-18);
}

}  // namespace
}  // namespace paloc

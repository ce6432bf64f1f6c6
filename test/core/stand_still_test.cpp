// What a stand-still is worth: the stationary factors together with the IMU level the platform.

#include <gtest/gtest.h>

#include <numbers>
#include <random>

#include "paloc/core/fixed_lag_smoother.h"
#include "paloc/core/imu_buffer.h"

namespace paloc {
namespace {

constexpr double kGravity_mps2 = 9.80665;
constexpr double kNode_s = 0.1;
constexpr double kDegree = std::numbers::pi / 180;

/// Stands still for two seconds, with the first pose tilted by five degrees against the truth.
struct StandStill {
  double bias_prior_mps2 = 0.01;
  Vec3 bias_acc = Vec3(0.007, -0.006, 0.01);
  ImuNoise noise;

  NodeEstimate run() {
    std::mt19937_64 rng(11);
    std::normal_distribution<double> normal;
    ImuBuffer imu;
    Vec3 force = Vec3::Zero();
    constexpr int kSamples = 440;
    for (int k = 0; k < kSamples; ++k) {
      const double sigma = noise.accelerometer_noise_density_mps2_sqrthz * std::sqrt(200.0);
      ImuSample sample;
      sample.t_ns = k * 5'000'000LL;
      sample.acc_body = Vec3(0, 0, kGravity_mps2) + bias_acc +
                        sigma * Vec3(normal(rng), normal(rng), normal(rng));
      imu.add(sample);
      force += sample.acc_body / kSamples;
    }
    FixedLagSmoother smoother{SmootherSettings()};
    smoother.add(first());
    for (int k = 1; k <= 20; ++k) smoother.add(next(smoother.newest(), imu, force));
    return smoother.newest();
  }

  ChainNode first() const {
    ChainNode node;
    node.state.T_map_body.rotation = so3::exp(5 * kDegree * Vec3(0.6, 0.8, 0));
    StateVector sigma;
    sigma << Vec3::Constant(0.05), Vec3::Constant(6 * kDegree), Vec3::Constant(0.5),
        Vec3::Constant(bias_prior_mps2), Vec3::Constant(0.01), Vec3::Constant(1e-4);
    node.node_factors.push_back(PriorFactor::fromSigmas(node.state, sigma));
    return node;
  }

  ChainNode next(const NodeEstimate& last, const ImuBuffer& imu, const Vec3& force) const {
    ChainNode node;
    node.t_ns = last.t_ns + nsFromSeconds(kNode_s);
    const auto p =
        imu.integrate(last.t_ns, node.t_ns, 0.02, noise, last.state.bias_acc, last.state.bias_gyro);
    const ImuFactor factor(*p, kGravity_mps2);
    node.state = factor.predict(last.state);
    node.edge_factors = {factor, BiasWalkFactor(noise, kNode_s),
                         ConstantGravityFactor(1e-6, kNode_s), NoMotionFactor(0.002, 0.001)};
    node.node_factors = {ZeroVelocityFactor(0.01), GravityFactor(force, 0.005, 0.001)};
    return node;
  }

  static double tiltOf(const NodeEstimate& estimate) {
    const Vec3 up_body = estimate.state.T_map_body.rotation.transpose() * Vec3::UnitZ();
    return std::acos(std::min(1.0, up_body.z()));
  }
  static double tiltSigmaOf(const NodeEstimate& estimate) {
    return std::sqrt(estimate.covariance.diagonal().segment<2>(tangent::kRotation).sum());
  }
};

TEST(StandStill, LevelsThePlatformWhereTheBiasIsKnown) {
  StandStill still;
  const NodeEstimate end = still.run();
  EXPECT_LT(StandStill::tiltOf(end), 0.1 * kDegree);
  EXPECT_LT(StandStill::tiltOf(end), 3 * StandStill::tiltSigmaOf(end));
  EXPECT_LT(end.state.v_map.norm(), 0.01);
}

TEST(StandStill, LevelsItAsFarAsTheBiasAllowsAndTheCovarianceTells) {
  StandStill still;
  still.bias_prior_mps2 = 0.2;
  still.bias_acc = Vec3(0.15, -0.2, 0.05);
  const NodeEstimate end = still.run();
  const double bias_tilt = std::hypot(0.15, 0.2) / kGravity_mps2;
  EXPECT_GT(StandStill::tiltOf(end), 0.5 * bias_tilt) << "nothing told this bias from a tilt";
  EXPECT_LT(StandStill::tiltOf(end), 3 * StandStill::tiltSigmaOf(end));
  EXPECT_NEAR(StandStill::tiltSigmaOf(end), std::sqrt(2.0) * 0.2 / kGravity_mps2,
              0.3 * std::sqrt(2.0) * 0.2 / kGravity_mps2);
}

}  // namespace
}  // namespace paloc

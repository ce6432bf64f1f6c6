#pragma once

#include "paloc/core/chain.h"
#include "random_states.h"

namespace paloc {

/// A simulated drive, a node every 0.1 s: what a smoother is fed with, and the truth. The motion
/// between two nodes is one of constant body rates, so that preintegration without noise is exact.
class SimulatedChain {
 public:
  static constexpr double kDt_s = 0.1, kGravity_mps2 = 9.81;

  explicit SimulatedChain(unsigned seed) : random(seed) {
    truth.bias_acc = random.vector(0.05);
    truth.bias_gyro = random.vector(0.005);
  }

  /// What is known before the first measurement: the true pose, and that biases are small.
  ChainNode first() {
    State mean = truth;
    mean.bias_acc.setZero();
    mean.bias_gyro.setZero();
    return firstWith(mean);
  }

  /// The same, but its errors are drawn from the prior that it has.
  ChainNode firstDrawn() {
    StateVector error;
    for (int k = 0; k < tangent::kDim; ++k) error[k] = random.normal(priorSigma()[k]);
    return firstWith(boxplus(truth, error));
  }

  /// The next node with IMU, bias and gravity factors, predicted from `last`, the estimate before.
  ChainNode next(const State& last) {
    const Vec3 acc_true = acc_true_ = 0.7 * acc_true_ + random.vector(0.5);
    const Vec3 omega_true = omega_true_ = 0.7 * omega_true_ + random.vector(0.2);
    Preintegration exact(noise, truth.bias_acc, truth.bias_gyro);
    Preintegration measured(noise, last.bias_acc, last.bias_gyro);
    const double step_s = kDt_s / 20;
    const double acc_sigma = noise.accelerometer_noise_density_mps2_sqrthz / std::sqrt(step_s);
    const double gyro_sigma = noise.gyroscope_noise_density_radps_sqrthz / std::sqrt(step_s);
    const Vec3 up_body = truth.T_map_body.rotation.transpose() * -truth.gravity_map;
    for (int k = 0; k < 20; ++k) {
      const Vec3 acc = acc_true + kGravity_mps2 * up_body + truth.bias_acc;
      const Vec3 omega = omega_true + truth.bias_gyro;
      exact.integrate(acc, omega, step_s);
      measured.integrate(acc + random.vector(acc_sigma), omega + random.vector(gyro_sigma), step_s);
    }
    before = truth;
    truth = ImuFactor(exact, kGravity_mps2).predict(truth);
    truth.bias_acc += random.vector(noise.accelerometer_bias_walk_mps3_sqrthz * std::sqrt(kDt_s));
    truth.bias_gyro += random.vector(noise.gyroscope_bias_walk_radps2_sqrthz * std::sqrt(kDt_s));
    t_ns_ += nsFromSeconds(kDt_s);
    const ImuFactor imu(measured, kGravity_mps2);
    ChainNode node;
    node.t_ns = t_ns_;
    node.state = imu.predict(last);
    node.edge_factors = {imu, BiasWalkFactor(noise, kDt_s), ConstantGravityFactor(1e-6, kDt_s)};
    return node;
  }

  MapFactor map(const State& of, double sigma_m = 0.02, double sigma_rad = 0.004) {
    Vec6 information;
    information << Vec3::Constant(1 / (sigma_m * sigma_m)),
        Vec3::Constant(1 / (sigma_rad * sigma_rad));
    Vec6 error;
    error << random.vector(sigma_m), random.vector(sigma_rad);
    return MapFactor(boxplus(of.T_map_body, error), information.asDiagonal());
  }

  LidarOdometryFactor odometry(double sigma_m = 0.01, double sigma_rad = 0.002) {
    Vec6 variances;
    variances << Vec3::Constant(sigma_m * sigma_m), Vec3::Constant(sigma_rad * sigma_rad);
    Vec6 error;
    error << random.vector(sigma_m), random.vector(sigma_rad);
    const Pose motion = before.T_map_body.inverse() * truth.T_map_body;
    return LidarOdometryFactor(boxplus(motion, error), variances.asDiagonal());
  }

  RandomStates random;
  ImuNoise noise;
  State truth, before;  ///< at the node made last, and at the one before it

 private:
  static StateVector priorSigma() {
    StateVector sigma;
    sigma << Vec3::Constant(0.05), Vec3::Constant(0.01), Vec3::Constant(0.1), Vec3::Constant(0.05),
        Vec3::Constant(0.005), Vec3::Constant(1e-3);
    return sigma;
  }
  ChainNode firstWith(const State& mean) {
    ChainNode node;
    node.state = mean;
    node.node_factors.push_back(PriorFactor::fromSigmas(mean, priorSigma()));
    t_ns_ = node.t_ns;
    return node;
  }

  Vec3 acc_true_ = Vec3::Zero(), omega_true_ = Vec3::Zero();
  TimeNs t_ns_ = 0;
};

/// The normal equations of a chain, dense.
struct DenseSystem {
  explicit DenseSystem(const std::vector<ChainNode>& nodes) {
    const auto n = static_cast<Eigen::Index>(nodes.size()) * tangent::kDim;
    hessian = Eigen::MatrixXd::Zero(n, n);
    b = Eigen::VectorXd::Zero(n);
    for (std::size_t k = 0; k < nodes.size(); ++k) {
      const ChainBlock block = linearize(k == 0 ? nullptr : &nodes[k - 1], nodes[k]);
      const Eigen::Index j = static_cast<Eigen::Index>(k) * tangent::kDim, i = j - tangent::kDim;
      hessian.block<tangent::kDim, tangent::kDim>(j, j) += block.hessian_jj;
      b.segment<tangent::kDim>(j) += block.b_j;
      if (k == 0) continue;
      hessian.block<tangent::kDim, tangent::kDim>(i, i) += block.hessian_ii;
      hessian.block<tangent::kDim, tangent::kDim>(j, i) += block.hessian_ji;
      hessian.block<tangent::kDim, tangent::kDim>(i, j) += block.hessian_ji.transpose();
      b.segment<tangent::kDim>(i) += block.b_i;
    }
  }

  Eigen::MatrixXd hessian;
  Eigen::VectorXd b;
};

}  // namespace paloc

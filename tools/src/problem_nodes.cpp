#include "problem_nodes.h"

#include <algorithm>
#include <limits>

namespace paloc {
namespace {

// As smoother problems are defined; gravity is one for all nodes, but for rounding.
constexpr double kGravity_mps2 = 9.81;
constexpr double kGravityWalk_sqrthz = 1e-6;
constexpr double kPriorSigmaVelocity_mps = 0.1, kPriorSigmaBiasAcc_mps2 = 0.1,
                 kPriorSigmaBiasGyro_radps = 0.01, kPriorSigmaGravity = 1e-4;

Preintegration preintegrate(const ImuNoise& noise, const SmootherProblem::Node& before,
                            const SmootherProblem::Node& node, const State& last) {
  Preintegration p(noise, last.bias_acc, last.bias_gyro);
  // What came last before the interval holds until the first sample within it.
  const ImuSample* held = before.imu.empty() ? nullptr : &before.imu.back();
  TimeNs held_since_ns = before.t_ns;
  const auto holdUntil = [&](TimeNs t_ns) {
    const TimeNs end_ns = std::min(t_ns, node.t_ns);
    if (!held || end_ns <= held_since_ns) return;
    const double dt_s = secondsBetween(held_since_ns, end_ns);
    // The force is that in the body frame where the sample begins, and holds while the body turns
    // away from it; a step of Preintegration has it turn with the body. So it is handed over with
    // the mean turn of the step undone.
    const Vec3 turn = dt_s * (held->omega_body - last.bias_gyro);
    const Vec3 force_body =
        so3::rightJacobianInverse(-turn) * (held->acc_body - last.bias_acc) + last.bias_acc;
    p.integrate(force_body, held->omega_body, dt_s);
    held_since_ns = end_ns;
  };
  for (const ImuSample& sample : node.imu) {
    holdUntil(sample.t_ns);
    // Without any sample before it, the first one stands for the time before it, too.
    held = &sample;
  }
  holdUntil(node.t_ns);
  return p;
}

void addMapFactors(const SmootherProblem::Node& source, std::size_t k, ChainNode& node) {
  for (const SmootherProblem::MapMeasurement& map : source.map) {
    if (map.node == k) node.node_factors.emplace_back(MapFactor(map.T_map_body, map.information));
  }
}

}  // namespace

ChainNode firstProblemNode(const SmootherProblem::Node& first) {
  ChainNode node;
  node.t_ns = first.t_ns;
  node.state.T_map_body = first.map.empty() ? first.T_map_body_true : first.map[0].T_map_body;
  node.state.v_map = first.v_map_true;
  StateVector sigma;
  sigma << Vec6::Constant(std::numeric_limits<double>::infinity()),
      Vec3::Constant(kPriorSigmaVelocity_mps), Vec3::Constant(kPriorSigmaBiasAcc_mps2),
      Vec3::Constant(kPriorSigmaBiasGyro_radps), Vec3::Constant(kPriorSigmaGravity);
  node.node_factors.emplace_back(PriorFactor::fromSigmas(node.state, sigma));
  addMapFactors(first, 0, node);
  return node;
}

ChainNode nextProblemNode(const ImuNoise& noise, const SmootherProblem::Node& before,
                          const SmootherProblem::Node& source, std::size_t k, const State& last) {
  const double dt_s = secondsBetween(before.t_ns, source.t_ns);
  ChainNode node;
  node.t_ns = source.t_ns;
  node.node_factors.reserve(2);
  node.edge_factors.reserve(4);
  const Preintegration imu = preintegrate(noise, before, source, last);
  if (imu.dt_s > 0) {
    const ImuFactor factor(imu, kGravity_mps2);
    node.state = factor.predict(last);
    node.edge_factors.emplace_back(factor);
  } else {
    // Nothing but the odometry, if there is any, tells of the motion.
    node.state = last;
    if (!source.odometry.empty()) {
      node.state.T_map_body = last.T_map_body * source.odometry[0].T_i_j;
    }
    node.edge_factors.emplace_back(VelocityFactor(dt_s, 0.5));
  }
  node.edge_factors.emplace_back(BiasWalkFactor(noise, dt_s));
  node.edge_factors.emplace_back(ConstantGravityFactor(kGravityWalk_sqrthz, dt_s));
  for (const SmootherProblem::OdometryMeasurement& odometry : source.odometry) {
    node.edge_factors.emplace_back(LidarOdometryFactor(odometry.T_i_j, odometry.covariance));
  }
  addMapFactors(source, k, node);
  return node;
}

}  // namespace paloc

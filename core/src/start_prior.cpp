#include "paloc/core/start_prior.h"

#include <limits>

namespace paloc {

PriorFactor startPrior(const State& first, const EstimatorSettings& settings) {
  using namespace tangent;
  const auto informationOf = [](double sigma) { return 1 / (sigma * sigma); };
  StateMatrix information = StateMatrix::Zero();
  information.diagonal().segment<3>(kVelocity).setConstant(
      informationOf(settings.prior_sigma_velocity_mps));
  information.diagonal().segment<3>(kBiasAcc).setConstant(
      informationOf(settings.prior_sigma_bias_acc_mps2));
  information.diagonal().segment<3>(kBiasGyro).setConstant(
      informationOf(settings.prior_sigma_bias_gyro_radps));
  const Vec3 down = first.gravity_map.normalized();
  const Mat3 along = down * down.transpose();
  information.block<3, 3>(kGravity, kGravity) =
      informationOf(settings.prior_sigma_gravity_direction_rad) * (Mat3::Identity() - along) +
      informationOf(settings.prior_sigma_gravity_magnitude) * along;
  return PriorFactor(first, information, StateVector::Zero());
}

ChainNode withoutPast(ChainNode node, const EstimatorSettings& settings) {
  node.edge_factors.clear();
  node.node_factors.insert(node.node_factors.begin(), startPrior(node.state, settings));
  return node;
}

}  // namespace paloc

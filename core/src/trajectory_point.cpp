#include "paloc/core/trajectory_point.h"

#include "paloc/core/mrpt_pose.h"

namespace paloc {

TrajectoryPoint trajectoryPoint(const NodeEstimate& estimate, const MapMatch& match) {
  const auto sigma = [&](int offset) -> Vec3 {
    return estimate.covariance.diagonal().segment<3>(offset).cwiseMax(0.0).cwiseSqrt();
  };
  TrajectoryPoint point;
  point.t_ns = estimate.t_ns;
  point.T_map_body = toMrpt(estimate.state.T_map_body);
  point.v_map = estimate.state.v_map;
  point.bias_acc = estimate.state.bias_acc;
  point.bias_gyro = estimate.state.bias_gyro;
  point.gravity_map = estimate.state.gravity_map;
  point.covariance = estimate.covariance.topLeftCorner<6, 6>();
  point.v_sigma = sigma(tangent::kVelocity);
  point.bias_acc_sigma = sigma(tangent::kBiasAcc);
  point.bias_gyro_sigma = sigma(tangent::kBiasGyro);
  point.gravity_sigma = sigma(tangent::kGravity);
  if (match.accepted()) point.directions = match.directions;
  return point;
}

}  // namespace paloc

#pragma once

#include "paloc/core/pose.h"
#include "paloc/core/time.h"

namespace paloc {

/// Offsets in the tangent space of State. Position first, as MRPT does.
namespace tangent {
inline constexpr int kPosition = 0;   ///< m, map frame, additive
inline constexpr int kRotation = 3;   ///< rad, on the right: R Exp(w)
inline constexpr int kVelocity = 6;   ///< m/s, map frame, additive
inline constexpr int kBiasAcc = 9;    ///< m/s2, body frame, additive
inline constexpr int kBiasGyro = 12;  ///< rad/s, body frame, additive
inline constexpr int kGravity = 15;   ///< 1, map frame, additive; its length is held by a factor
inline constexpr int kDim = 18;
}  // namespace tangent

using StateVector = Eigen::Matrix<double, tangent::kDim, 1>;
using StateMatrix = Eigen::Matrix<double, tangent::kDim, tangent::kDim>;

/// The state of one node, X = [R, t, v, b_a, b_g, g] of the PALoc paper.
struct State {
  Pose T_map_body;
  Vec3 v_map = Vec3::Zero();          ///< m/s
  Vec3 bias_acc = Vec3::Zero();       ///< m/s2, body frame
  Vec3 bias_gyro = Vec3::Zero();      ///< rad/s, body frame
  Vec3 gravity_map = -Vec3::UnitZ();  ///< direction of gravity, points down, of unit length
};

/// The state moved by a tangent vector.
inline State boxplus(const State& x, const StateVector& delta) {
  State y;
  y.T_map_body = boxplus(x.T_map_body, delta.segment<6>(tangent::kPosition));
  y.v_map = x.v_map + delta.segment<3>(tangent::kVelocity);
  y.bias_acc = x.bias_acc + delta.segment<3>(tangent::kBiasAcc);
  y.bias_gyro = x.bias_gyro + delta.segment<3>(tangent::kBiasGyro);
  y.gravity_map = x.gravity_map + delta.segment<3>(tangent::kGravity);
  return y;
}

/// The tangent vector that leads from `from` to `to`: boxplus(from, boxminus(to, from)) == to.
inline StateVector boxminus(const State& to, const State& from) {
  StateVector delta;
  delta.segment<6>(tangent::kPosition) = boxminus(to.T_map_body, from.T_map_body);
  delta.segment<3>(tangent::kVelocity) = to.v_map - from.v_map;
  delta.segment<3>(tangent::kBiasAcc) = to.bias_acc - from.bias_acc;
  delta.segment<3>(tangent::kBiasGyro) = to.bias_gyro - from.bias_gyro;
  delta.segment<3>(tangent::kGravity) = to.gravity_map - from.gravity_map;
  return delta;
}

}  // namespace paloc

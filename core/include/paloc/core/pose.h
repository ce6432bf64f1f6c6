#pragma once

#include "paloc/core/so3.h"
#include "paloc/core/types.h"

namespace paloc {

/// A rigid transform T_A_B: takes points of frame B to frame A, p_A = rotation * p_B + position.
/// Tangent space (6, [position (m), rotation (rad)]): position is added in frame A, rotation is
/// perturbed on the right, R Exp(w).
struct Pose {
  Vec3 position = Vec3::Zero();
  Mat3 rotation = Mat3::Identity();

  Pose operator*(const Pose& other) const {
    return {rotation * other.position + position, rotation * other.rotation};
  }
  Vec3 operator*(const Vec3& point) const { return rotation * point + position; }
  Pose inverse() const { return {-(rotation.transpose() * position), rotation.transpose()}; }
};

/// The pose moved by a tangent vector (6, [m, rad]).
inline Pose boxplus(const Pose& pose, const Vec6& delta) {
  return {pose.position + delta.head<3>(), pose.rotation * so3::exp(delta.tail<3>())};
}

/// The tangent vector (6, [m, rad]) that leads from `from` to `to`: boxplus(from, boxminus(to,
/// from)) == to.
inline Vec6 boxminus(const Pose& to, const Pose& from) {
  Vec6 delta;
  delta.head<3>() = to.position - from.position;
  delta.tail<3>() = so3::log(from.rotation.transpose() * to.rotation);
  return delta;
}

/// The pose between `from` (at ratio 0) and `to` (at 1): straight line, and the shortest rotation.
inline Pose interpolate(const Pose& from, const Pose& to, double ratio) {
  const Vec3 w = so3::log(from.rotation.transpose() * to.rotation);
  return {from.position + ratio * (to.position - from.position),
          from.rotation * so3::exp(ratio * w)};
}

}  // namespace paloc

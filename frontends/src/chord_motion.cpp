#include "paloc/frontends/chord_motion.h"

namespace paloc {

using chord::kBend;
using chord::kBendOfTurn;
using chord::kPosition;
using chord::kRate;
using chord::kRotation;
using chord::kVelocity;

ChordMotion boxplus(const ChordMotion& x, const ChordVector& delta) {
  ChordMotion y = x;
  const Mat3& R = x.T_odom_body.rotation;
  y.T_odom_body.position += delta.segment<3>(kPosition);
  y.T_odom_body.rotation = so3::normalized(so3::exp(Vec3(delta.segment<3>(kRotation))) * R);
  y.v_odom += delta.segment<3>(kVelocity);
  y.omega_body += R.transpose() * delta.segment<3>(kRate);
  y.acceleration_odom += delta.segment<3>(kBend);
  y.angular_acceleration_body += R.transpose() * delta.segment<3>(kBendOfTurn);
  return y;
}

ChordVector boxminus(const ChordMotion& to, const ChordMotion& from) {
  ChordVector delta;
  const Mat3& R = from.T_odom_body.rotation;
  delta.segment<3>(kPosition) = to.T_odom_body.position - from.T_odom_body.position;
  delta.segment<3>(kRotation) = so3::log(to.T_odom_body.rotation * R.transpose());
  delta.segment<3>(kVelocity) = to.v_odom - from.v_odom;
  delta.segment<3>(kRate) = R * (to.omega_body - from.omega_body);
  delta.segment<3>(kBend) = to.acceleration_odom - from.acceleration_odom;
  delta.segment<3>(kBendOfTurn) =
      R * (to.angular_acceleration_body - from.angular_acceleration_body);
  return delta;
}

ChordMotion continued(const ChordMotion& x, double dt_s) {
  ChordMotion y = x;
  y.duration_s = dt_s;
  y.T_odom_body.position += dt_s * x.v_odom;
  y.T_odom_body.rotation = so3::normalized(x.T_odom_body.rotation * so3::exp(dt_s * x.omega_body));
  return y;
}

// Exp(e) R Exp((omega + R^T d) dt) = Exp(e) Exp(dt Jr(-R omega dt) d) R Exp(omega dt); and what is
// told of the body's axes turns with it.
ChordMatrix continuedTransition(const ChordMotion& x, double dt_s) {
  const Vec3 turn_odom = dt_s * (x.T_odom_body.rotation * x.omega_body);
  const Mat3 turn = so3::exp(turn_odom);
  ChordMatrix F = ChordMatrix::Identity();
  F.block<3, 3>(kPosition, kVelocity) = dt_s * Mat3::Identity();
  F.block<3, 3>(kRotation, kRate) = dt_s * so3::rightJacobian(-turn_odom);
  F.block<3, 3>(kRate, kRate) = turn;
  F.block<3, 3>(kBendOfTurn, kBendOfTurn) = turn;
  return F;
}

}  // namespace paloc

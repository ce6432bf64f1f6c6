#pragma once

#include <Eigen/Core>

#include "paloc/core/export.h"
#include "paloc/core/pose.h"

namespace paloc {

/// Offsets in the tangent space of ChordMotion.
namespace chord {
inline constexpr int kPosition = 0;     ///< m, odom frame, additive
inline constexpr int kRotation = 3;     ///< rad, odom frame, on the left: Exp(w) R
inline constexpr int kVelocity = 6;     ///< m/s, odom frame, additive
inline constexpr int kRate = 9;         ///< rad/s, odom frame: added to R omega
inline constexpr int kBend = 12;        ///< m/s2, odom frame, additive
inline constexpr int kBendOfTurn = 15;  ///< rad/s2, odom frame: added to R alpha
inline constexpr int kDim = 18;
}  // namespace chord

using ChordVector = Eigen::Matrix<double, chord::kDim, 1>;
using ChordMatrix = Eigen::Matrix<double, chord::kDim, chord::kDim>;

/// The state of an odometry without an IMU: a pose, and how the body came there since the pose
/// before: along a chord, at a constant velocity, and beside it by the sag s = tau (T - tau) / 2 of
/// a constant acceleration. A time of tau earlier it was at p - v tau - a s, R Exp(-omega tau -
/// alpha s). Both ends lie on the chord, so that consecutive ones join whatever their bends are.
struct ChordMotion {
  Pose T_odom_body;
  Vec3 v_odom = Vec3::Zero();                     ///< mean velocity (m/s)
  Vec3 omega_body = Vec3::Zero();                 ///< mean rate (rad/s)
  Vec3 acceleration_odom = Vec3::Zero();          ///< a (m/s2)
  Vec3 angular_acceleration_body = Vec3::Zero();  ///< alpha (rad/s2)
  double duration_s = 0;                          ///< T, of the chord

  /// s (s2).
  double sag(double age_s) const { return 0.5 * age_s * (duration_s - age_s); }
  /// T_odom_body `age_s` earlier.
  Pose before(double age_s) const {
    const double s = sag(age_s);
    return {T_odom_body.position - age_s * v_odom - s * acceleration_odom,
            T_odom_body.rotation * so3::exp(-age_s * omega_body - s * angular_acceleration_body)};
  }
};

/// The state moved by a tangent vector.
PALOC_EXPORT ChordMotion boxplus(const ChordMotion& x, const ChordVector& delta);

/// The tangent vector at `from` that leads to `to`: boxplus(from, boxminus(to, from)) == to.
PALOC_EXPORT ChordVector boxminus(const ChordMotion& to, const ChordMotion& from);

/// The state `dt_s` later, with the same velocities and bend.
PALOC_EXPORT ChordMotion continued(const ChordMotion& x, double dt_s);

/// Derivative of the continued state's error by the error of x (18 x 18).
PALOC_EXPORT ChordMatrix continuedTransition(const ChordMotion& x, double dt_s);

}  // namespace paloc

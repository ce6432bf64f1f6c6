#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "paloc/core/export.h"
#include "paloc/core/pose.h"

namespace paloc {

/// Offsets in the tangent space of LioState.
namespace lio {
inline constexpr int kPosition = 0;   ///< m, odom frame, additive
inline constexpr int kRotation = 3;   ///< rad, on the right: R Exp(w)
inline constexpr int kVelocity = 6;   ///< m/s, odom frame, additive
inline constexpr int kBiasAcc = 9;    ///< m/s2, body frame, additive
inline constexpr int kBiasGyro = 12;  ///< rad/s, body frame, additive
inline constexpr int kGravity = 15;   ///< rad (2): on the sphere, Exp(B(g) d) g
inline constexpr int kDim = 17;
}  // namespace lio

using LioVector = Eigen::Matrix<double, lio::kDim, 1>;
using LioMatrix = Eigen::Matrix<double, lio::kDim, lio::kDim>;

/// Two unit vectors (3 x 2) that span the plane across `direction`; smooth but for one direction,
/// which is up: gravity never points there for long.
inline Eigen::Matrix<double, 3, 2> tangentBasis(const Vec3& direction) {
  // The rotation that turns -z into the direction takes x and y along.
  const Vec3 d = direction.normalized();
  const Mat3 rotation = Eigen::Quaterniond::FromTwoVectors(-Vec3::UnitZ(), d).toRotationMatrix();
  return rotation.leftCols<2>();
}

/// The state of the LiDAR-inertial odometry at one instant. The odom frame is the body's at the end
/// of the first scan, and so is not level: gravity is a state (W. Xu et al., "FAST-LIO2: Fast
/// Direct LiDAR-Inertial Odometry", 2022, equation 1).
struct LioState {
  Pose T_odom_body;
  Vec3 v_odom = Vec3::Zero();                ///< m/s
  Vec3 bias_acc = Vec3::Zero();              ///< m/s2, body frame
  Vec3 bias_gyro = Vec3::Zero();             ///< rad/s, body frame
  Vec3 gravity_odom = Vec3(0, 0, -9.80665);  ///< m/s2, points down, of known length
};

/// The state moved by a tangent vector.
PALOC_EXPORT LioState boxplus(const LioState& x, const LioVector& delta);

/// The tangent vector at `from` that leads to `to`: boxplus(from, boxminus(to, from)) == to.
PALOC_EXPORT LioVector boxminus(const LioState& to, const LioState& from);

}  // namespace paloc

#pragma once

#include "paloc/core/export.h"
#include "paloc/core/types.h"

/// Functions of the rotation group SO(3). Angles in rad. Sources: Sola et al., "A micro Lie theory
/// for state estimation in robotics" (2018), section IV and appendix B; Forster et al.,
/// "On-Manifold Preintegration" (2017), equations 3 to 10.
namespace paloc::so3 {

/// The skew-symmetric matrix of v: hat(v) * u = v x u.
PALOC_EXPORT Mat3 hat(const Vec3& v);

/// Exponential map, Exp(w) = exp(hat(w)). Exact for any w.
PALOC_EXPORT Mat3 exp(const Vec3& w);

/// Logarithm, the inverse of exp with |result| <= pi. Accurate near identity and near pi.
PALOC_EXPORT Vec3 log(const Mat3& rotation);

/// Right Jacobian: Exp(w + d) = Exp(w) Exp(rightJacobian(w) d) to first order.
PALOC_EXPORT Mat3 rightJacobian(const Vec3& w);

/// Its inverse: Log(Exp(w) Exp(d)) = w + rightJacobianInverse(w) d to first order, |w| < 2 pi.
PALOC_EXPORT Mat3 rightJacobianInverse(const Vec3& w);

/// The rotation matrix nearest to an almost orthogonal one (removes accumulated rounding).
PALOC_EXPORT Mat3 normalized(const Mat3& rotation);

}  // namespace paloc::so3

#pragma once

#include "paloc/core/linearization.h"

namespace paloc {

/// The unwhitened residual that factors on the motion between two nodes share,
///
///   r = [ R_i^T (t_j - t_i) - t_Z ; Log(R_Z^T R_i^T R_j) ]     (6, [m in body i, rad])
///
/// which is T_i^-1 T_j less the measured Z in the tangent space of Pose.
PALOC_EXPORT EdgeLinearization<6> relativePoseResidual(const State& i, const State& j,
                                                       const Pose& T_i_j_measured);

}  // namespace paloc

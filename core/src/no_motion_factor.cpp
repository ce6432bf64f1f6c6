#include "paloc/core/no_motion_factor.h"

namespace paloc {

NoMotionFactor::NoMotionFactor(double sigma_position_m, double sigma_rotation_rad,
                               RobustKernel kernel)
    : inverse_sigma_position_(1 / sigma_position_m),
      inverse_sigma_rotation_(1 / sigma_rotation_rad),
      kernel_(kernel) {}

EdgeLinearization<6> NoMotionFactor::linearize(const State& i, const State& j) const {
  EdgeLinearization<6> l = relativePoseResidual(i, j, Pose());
  Eigen::Matrix<double, 6, 1> weights;
  weights << Vec3::Constant(inverse_sigma_position_), Vec3::Constant(inverse_sigma_rotation_);
  whiten(weights.asDiagonal(), l);
  return l;
}

}  // namespace paloc

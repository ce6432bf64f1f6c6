#include "paloc/core/lidar_odometry_factor.h"

#include "paloc/core/square_root_information.h"

namespace paloc {

LidarOdometryFactor::LidarOdometryFactor(const Pose& T_i_j_measured, const Mat6& covariance,
                                         RobustKernel kernel)
    : T_i_j_measured_(T_i_j_measured),
      sqrt_information_(sqrtInformationOfCovariance(covariance)),
      kernel_(kernel) {}

EdgeLinearization<6> LidarOdometryFactor::linearize(const State& i, const State& j) const {
  EdgeLinearization<6> l = relativePoseResidual(i, j, T_i_j_measured_);
  whiten(sqrt_information_, l);
  return l;
}

}  // namespace paloc

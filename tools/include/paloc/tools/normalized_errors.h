#pragma once

#include <cstddef>
#include <vector>

#include "paloc/core/pose.h"
#include "paloc/core/types.h"

namespace paloc {

/// Normalised errors of poses: the square of an error in units of its covariance, per degree of
/// freedom (NEES/dof). 1 where the covariance is right, more where it is too sure.
struct NormalizedErrors {
  std::size_t poses = 0;
  double pose = 0, position = 0, rotation = 0;  ///< means
  double pose_p95 = 0;
  double outside_99 = 0;  ///< share of poses outside their ellipsoid of 99 % (0.01 is right)
  double position_rmse_m = 0, position_max_m = 0;
  double position_sigma_m = 0;  ///< root of the mean trace: what the covariance says of the RMSE
  double rotation_rmse_rad = 0, rotation_sigma_rad = 0;
};

/// Collects the errors of poses.
class NormalizedErrorSums {
 public:
  /// The covariance is that of `estimate`: tangent [position in map, rotation on the right]. False,
  /// and nothing is added, if it is not positive definite.
  bool add(const Pose& estimate, const Pose& reference, const Mat6& covariance);

  NormalizedErrors result() const;

 private:
  std::vector<double> nees_, position_m_, rotation_rad_;
  double position_ = 0, rotation_ = 0, outside_ = 0;
  double position_trace_ = 0, rotation_trace_ = 0;
};

}  // namespace paloc

#pragma once

#include <filesystem>
#include <map>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "paloc/tools/error_statistics.h"
#include "paloc/tools/trajectory_covariance.h"

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

struct EvalCovarianceResult {
  std::size_t reference_poses = 0, estimate_poses = 0;
  NormalizedErrors all;
  std::map<std::string, NormalizedErrors> by_flag;
  std::size_t unusable = 0;  ///< matched poses whose covariance is not finite or not positive
};

/// Compares each pose of the estimate with the reference's of the same time (within `max_dt_s`); no
/// alignment, since the covariance is that of the pose in the map. Throws IoError if no two belong
/// together.
EvalCovarianceResult evaluateCovariance(const std::vector<StampedPose>& reference,
                                        const std::vector<CovariantPose>& estimate,
                                        double max_dt_s);

/// The result as a table for people.
std::string tableOf(const EvalCovarianceResult& result);

/// The result as JSON: m, rad, shares from 0 to 1.
nlohmann::ordered_json jsonOf(const EvalCovarianceResult& result);

}  // namespace paloc

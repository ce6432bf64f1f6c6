#pragma once

#include <filesystem>
#include <map>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "paloc/core/trajectory.h"
#include "paloc/tools/normalized_errors.h"
#include "paloc/tools/trajectory_covariance.h"

namespace paloc {

struct EvalCovarianceResult {
  std::size_t reference_poses = 0, estimate_poses = 0;
  NormalizedErrors all;
  std::map<std::string, NormalizedErrors> by_flag;
  std::size_t unusable = 0;  ///< matched poses whose covariance is not finite or not positive
};

/// A trajectory as the rows of its trajectory_cov.csv.
std::vector<CovariantPose> covariantPoses(const std::vector<TrajectoryPoint>& trajectory);

/// Compares each pose of the estimate with the reference's of the same time (within `max_dt_s`); no
/// alignment, since the covariance is that of the pose in the map. Throws IoError if no two belong
/// together.
EvalCovarianceResult evaluateCovariance(const std::vector<StampedPose>& reference,
                                        const std::vector<CovariantPose>& estimate,
                                        double max_dt_s);

/// Normalised errors as a table for people, a row each, all of them last.
std::string tableOf(const std::map<std::string, NormalizedErrors>& rows,
                    const NormalizedErrors& all);

/// The result as a table for people.
std::string tableOf(const EvalCovarianceResult& result);

/// As JSON: m, rad, shares from 0 to 1.
nlohmann::ordered_json jsonOf(const NormalizedErrors& errors);
nlohmann::ordered_json jsonOf(const EvalCovarianceResult& result);

}  // namespace paloc

#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "paloc/core/types.h"
#include "paloc/frontends/tum_file.h"

namespace paloc {

/// A row of trajectory_cov.csv.
struct CovariantPose {
  StampedPose pose;                ///< body in the map
  Mat6 covariance = Mat6::Zero();  ///< tangent [position in map (m), rotation on the right (rad)]
  std::string flag;
};

/// Reads a trajectory_cov.csv: time, pose, pose covariance and flag; other columns are passed over.
/// Throws IoError (file, line, column) where it is not one.
std::vector<CovariantPose> readTrajectoryCovariance(const std::filesystem::path& file);

}  // namespace paloc

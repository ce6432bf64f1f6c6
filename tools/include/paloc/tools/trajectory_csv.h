#pragma once

#include <string>
#include <vector>

#include "paloc/core/trajectory.h"
#include "paloc/frontends/tum_file.h"

namespace paloc {

/// The trajectory as TUM poses: the body in the map's frame.
std::vector<StampedPose> stampedPoses(const std::vector<TrajectoryPoint>& trajectory);

/// trajectory_cov.csv: pose, velocity, biases, the 21 terms of the pose covariance (upper triangle
/// by rows, order position in the map frame, rotation on the right; m2, m rad, rad2), flag, the six
/// classes.
std::string trajectoryCsv(const std::vector<TrajectoryPoint>& trajectory);

/// Names of the 21 columns of the pose covariance in trajectory_cov.csv, in their order.
std::vector<std::string> covarianceColumns();

/// diagnostics.csv: a row per scan.
std::string diagnosticsCsv(const std::vector<FrameDiagnostics>& diagnostics);

/// "full", "partial" or "none".
std::string toString(DirectionClass cls);

}  // namespace paloc

#pragma once

#include <string>
#include <vector>

#include "paloc/core/trajectory.h"
#include "paloc/frontends/tum_file.h"

namespace paloc {

/// The trajectory as TUM poses: the body in the map's frame.
std::vector<StampedPose> stampedPoses(const std::vector<TrajectoryPoint>& trajectory);

/// trajectory_cov.csv: pose, velocity, biases, the 21 terms of the pose covariance (upper triangle
/// by rows, order position in the map frame, rotation on the right; m2, m rad, rad2), flag, and of
/// the six directions that the map's answer has, class, name (see directionName()) and the pose's
/// standard deviation along it (m, rad). Where there is no map factor: none, and no names.
std::string trajectoryCsv(const std::vector<TrajectoryPoint>& trajectory);

/// Names of the 21 columns of the pose covariance in trajectory_cov.csv, in their order.
std::vector<std::string> covarianceColumns();

/// diagnostics.csv: a row per scan. The standard deviations are those of the match alone, 1e6 for a
/// direction that it leaves open; `spectrum_de` is MapMatch::spectrum.
std::string diagnosticsCsv(const std::vector<FrameDiagnostics>& diagnostics);

/// "full", "partial" or "none".
std::string toString(DirectionClass cls);

}  // namespace paloc

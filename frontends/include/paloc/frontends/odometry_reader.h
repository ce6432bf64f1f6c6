#pragma once

#include <mrpt/obs/CObservation.h>

#include <optional>
#include <string>

#include "paloc/core/export.h"
#include "paloc/core/pose.h"
#include "paloc/core/time.h"

namespace paloc {

/// One pose of a recorded odometry.
struct OdometryPose {
  TimeNs t_ns = 0;
  Pose T_odom_body;
  /// Covariance (6 x 6, the tangent space of Pose: [position in the odom frame (m), rotation on the
  /// right (rad)]) of the motion since the stream's pose before; nothing if the stream tells none.
  std::optional<Mat6> step_covariance;
};

/// Whether this is a pose of an odometry: CObservationRobotPose (3-D) or CObservationOdometry
/// (2-D).
PALOC_EXPORT bool isOdometry(const mrpt::obs::CObservation& observation);

/// Reads it. The pose is that of the sensor which `sensorPose` places on the body, so T_odom_body =
/// pose * sensorPose^-1. A covariance of zero means that none is known. MRPT does not say whether a
/// covariance is that of the cumulative pose or of the last step; here it is the step's. A 2-D
/// odometry has no covariance. Nothing, with a reason, where a value is not finite or a covariance
/// has a negative variance.
PALOC_EXPORT std::optional<OdometryPose> decodeOdometry(const mrpt::obs::CObservation& observation,
                                                        std::string& refusal);

}  // namespace paloc

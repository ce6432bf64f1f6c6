#pragma once

#include <mrpt/obs/CObservationIMU.h>
#include <mrpt/obs/CObservationRobotPose.h>

#include <string>

#include "paloc/core/imu_sample.h"
#include "paloc/frontends/tum_file.h"

namespace paloc {

/// An IMU sample as a rawlog holds it.
mrpt::obs::CObservationIMU imuObservation(const ImuSample& sample, const std::string& label);

/// A pose of an odometry (T_odom_body, cumulative), of which no covariance is known.
mrpt::obs::CObservationRobotPose poseObservation(const StampedPose& pose, const std::string& label);

}  // namespace paloc

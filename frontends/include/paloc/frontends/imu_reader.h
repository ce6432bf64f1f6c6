#pragma once

#include <mrpt/obs/CObservationIMU.h>

#include <optional>
#include <string>

#include "paloc/core/export.h"
#include "paloc/core/imu_sample.h"

namespace paloc {

/// Reads specific force (m/s2) and angular rate (rad/s) into the body's axes (`sensorPose`'s
/// rotation applied). The body frame is the IMU's: a sensor pose with a lever arm is refused, as
/// the force at the body's origin cannot be told from it. Nothing, with a reason, where a value is
/// missing or not finite.
PALOC_EXPORT std::optional<ImuSample> decodeImu(const mrpt::obs::CObservationIMU& observation,
                                                std::string& refusal);

}  // namespace paloc

#pragma once

#include <optional>

#include "paloc/core/estimator_settings.h"
#include "paloc/core/imu_buffer.h"

namespace paloc {

/// The direction of up in the body frame at `t_ns` (unit vector): what the accelerometer felt over
/// the last three seconds, or as much of it as there is, turned with the gyroscope. A platform that
/// gains speed meanwhile leans it: 1 m/s in three seconds by 0.03 rad. Nothing without samples.
PALOC_EXPORT std::optional<Vec3> measuredUp(const ImuBuffer& imu, TimeNs t_ns,
                                            const EstimatorSettings& settings);

}  // namespace paloc

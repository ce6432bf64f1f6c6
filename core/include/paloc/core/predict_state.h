#pragma once

#include "paloc/core/odometry_frame.h"
#include "paloc/core/pose.h"
#include "paloc/core/state.h"

namespace paloc {

/// The state at a frame where no IMU data lead to it from the last node's: moved on by the
/// odometry's `motion` (T_last_body^-1 T_body) where the frame continues it, else at constant
/// velocity. `dt_s` > 0.
PALOC_EXPORT State predictWithoutImu(const State& last, const OdometryFrame& frame,
                                     const Pose& motion, double dt_s);

}  // namespace paloc

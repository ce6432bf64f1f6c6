#pragma once

#include "paloc/core/time.h"
#include "paloc/core/types.h"

namespace paloc {

/// One IMU measurement. The body frame is the IMU's frame.
struct ImuSample {
  TimeNs t_ns = 0;
  Vec3 acc_body = Vec3::Zero();    ///< specific force (m/s2): +9.81 upwards at rest
  Vec3 omega_body = Vec3::Zero();  ///< angular rate (rad/s)
};

}  // namespace paloc

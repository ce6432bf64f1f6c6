#pragma once

#include "paloc/core/imu_noise.h"
#include "paloc/core/preintegration.h"
#include "paloc/frontends/lio_state.h"

namespace paloc {

/// The state after the interval of a preintegration.
PALOC_EXPORT LioState predictLio(const LioState& x, const Preintegration& imu);

/// Derivative of the predicted state's error by the error of the state before (17 x 17).
PALOC_EXPORT LioMatrix lioTransition(const LioState& x, const Preintegration& imu);

/// Covariance that the interval adds: the IMU's white noise and the walk of its biases (17 x 17).
PALOC_EXPORT LioMatrix lioProcessNoise(const LioState& x, const Preintegration& imu,
                                       const ImuNoise& noise);

}  // namespace paloc

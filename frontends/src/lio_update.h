#pragma once

#include "iterated_update.h"
#include "paloc/frontends/lio_calibration.h"
#include "paloc/frontends/lio_state.h"

namespace paloc {

/// The update of a LioState with a scan whose rotation during it the IMU tells.
using LioUpdate = IteratedUpdate<LioState, lio::kDim, 9>;

/// The scan's rotation is on the left, in the odom frame; the state's on the right.
inline LioUpdate::ToMeasured lioToMeasured(const LioState& x) {
  LioUpdate::ToMeasured derivative = LioUpdate::ToMeasured::Identity();
  derivative.block<3, 3>(lio::kRotation, lio::kRotation) = x.T_odom_body.rotation;
  return derivative;
}

/// The same with a calibration.
using CalibratedLioUpdate =
    IteratedUpdate<CalibratedLioState, CalibratedLioState::kDim, 9, lio::kDim>;

}  // namespace paloc

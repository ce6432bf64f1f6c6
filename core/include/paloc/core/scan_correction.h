#pragma once

#include "paloc/core/export.h"
#include "paloc/core/fixed_lag_smoother.h"
#include "paloc/core/odometry_frame.h"

namespace paloc {

/// A scan with `v_body_assumed`, deskewed anew with a velocity `v_body` at its end (body frame,
/// m/s) and the bias of the gyroscope `bias_gyro` (body frame, rad/s), to first order in the
/// differences and but for the turn of a scan. A point of age a that was put at p belongs at
///
///   p + a (bias_gyro x p) - a (v_body - v_body_assumed):
///
/// the body turned by a * bias_gyro less than was taken, and came from so much further back.
PALOC_EXPORT Scan deskewedAnew(const Scan& scan, const Vec3& v_body, const Vec3& bias_gyro);

/// The frame with its scan, where it says how it was deskewed, deskewed by what the estimator knows
/// of velocity and bias: `last` is the last node's state with covariance, `predicted` the frame's
/// by IMU. The velocity is the mean of that and the one that was assumed, the odometry's, weighted
/// by the inverses of their variances. An odometry's step of 0.1 s that is off by 2 mm, and a bias
/// of 1.5 mrad/s, would move and turn scans by 1 mm and 0.08 mrad.
PALOC_EXPORT OdometryFrame withScanDeskewedAnew(const OdometryFrame& frame,
                                                const NodeEstimate& last, const State& predicted);

}  // namespace paloc

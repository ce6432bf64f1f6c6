#pragma once

#include "paloc/core/export.h"
#include "paloc/core/pose.h"
#include "paloc/core/scan.h"

namespace paloc {

/// A scan whose `skew` is not none, with the covariance that comes of it. `motion` is that of the
/// body in the `dt_s` (s, above 0) before the scan's end, its covariance (6 x 6) of the tangent
/// [position in the frame of its beginning, rotation on the right].
///
/// Points are on the mean half a scan older than its end: a scan deskewed with a velocity that is
/// off by e puts the body off by e T / 2, T the scan's duration. One that was not deskewed is moved
/// to where it lies if all of it was seen at half its time; on which side of the body what fixes
/// the pose was seen, and so when, leaves a quarter of the scan's motion (one sigma, of at most a
/// half).
PALOC_EXPORT Scan withSkewTold(const Scan& scan, const Pose& motion, const Mat6& covariance,
                               double dt_s);

}  // namespace paloc

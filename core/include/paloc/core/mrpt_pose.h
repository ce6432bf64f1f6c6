#pragma once

#include <mrpt/poses/CPose3D.h>
#include <mrpt/poses/CPose3DPDFGaussian.h>

#include "paloc/core/export.h"
#include "paloc/core/pose.h"

/// Conversions between MRPT's SE(3) types, which stand at paloc's borders, and paloc's own.
namespace paloc {

PALOC_EXPORT Pose fromMrpt(const mrpt::poses::CPose3D& pose);
PALOC_EXPORT mrpt::poses::CPose3D toMrpt(const Pose& pose);

/// The covariance of an MRPT Gaussian pose, whose order is (x, y, z, yaw, pitch, roll) in m and
/// rad, as 6 x 6 in the tangent space of Pose ([position in the outer frame, rotation on the
/// right], m and rad). Singular at a pitch of +-90 degrees.
PALOC_EXPORT Mat6 tangentCovariance(const mrpt::poses::CPose3DPDFGaussian& pose);

/// The reverse: a pose T_A_B with its tangent covariance (6 x 6) as MRPT's Gaussian.
PALOC_EXPORT mrpt::poses::CPose3DPDFGaussian toMrpt(const Pose& pose, const Mat6& covariance);

}  // namespace paloc

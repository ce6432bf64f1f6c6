#pragma once

#include "paloc/core/export.h"
#include "paloc/core/types.h"

namespace paloc {

/// Position or rotation: the two kinds of directions of a pose, by their offset in its tangent.
enum class DirectionKind { kPosition = 0, kRotation = 3 };

/// The sigma told of a direction that nothing constrains (m or rad).
constexpr double kUnknownSigma = 1e6;

/// The three by three block of one kind with the other kind eliminated (Schur complement):
/// S = H_own - H_own,other H_other^-1 H_other,own, symmetric; what H_other does not know stays out.
PALOC_EXPORT Mat3 schurComplement(const Mat6& information, DirectionKind own);

/// The inverse of a symmetric positive semidefinite block on the space where it is not zero.
PALOC_EXPORT Mat3 pseudoInverse(const Mat3& block);

/// Scales what is known along one direction, the unit vector `axis` of the kind `own`, by `factor`
/// (0..1): H - (1 - f) x x^T / (v^T S v) with x = (S v, 0). What other directions know by way of it
/// stays. `axis` is given in the frame of the tangent.
PALOC_EXPORT void scaleDirection(Mat6& information, DirectionKind own, const Vec3& axis,
                                 double factor);

/// After directions were taken away: rounding may leave an eigenvalue a little below zero, and
/// `spread` (shared_errors.h) must not reach into what is not known.
PALOC_EXPORT void cutToKnown(Mat6& information, Mat6& spread);

/// The projector onto what the information knows, as cutToKnown() tells it.
PALOC_EXPORT Mat6 projectorOntoKnown(const Mat6& information);

}  // namespace paloc

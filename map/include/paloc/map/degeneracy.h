#pragma once

#include <array>
#include <functional>
#include <span>

#include "paloc/core/export.h"
#include "paloc/core/map_matcher.h"
#include "paloc/core/types.h"
#include "paloc/map/map_information.h"

namespace paloc {

/// A small motion: translation v (m) and rotation w (rad) in the body frame.
struct Motion {
  Vec3 v = Vec3::Zero(), w = Vec3::Zero();
};

/// How clearly a scan would lie worse on the map with the body moved along a motion, to either
/// side: below 0 it would lie better somewhere, from 1 on it would lie clearly worse everywhere.
using MotionCheck = std::function<double(const Motion&)>;

/// The six directions of a pose as the map sees them, and the information that is left when the
/// weak ones have been scaled down.
struct ObservedDirections {
  std::array<MatchDirection, 6>
      directions;                     ///< 0..2 translation, 3..5 rotation; weakest first in each
  Mat6 information = Mat6::Zero();    ///< body tangent, symmetric, positive semidefinite
  Mat6 shared_spread = Mat6::Zero();  ///< what shared errors add (shared_errors.h); likewise
};

/// Classes the directions of a pose (design, 4.6). They are the eigenvectors of the Schur
/// complements S_t = H_tt - H_tR H_RR^-1 H_Rt and S_R of the rows' own H = J^T D^-1 J, so that a
/// corridor shows whichever way it lies and rotation and translation do not mix. Moving along
/// direction v, the other three free to follow, moves the point p by m = v + w x p, where (v, w) =
/// (v, -H_RR^-1 H_Rt v), or likewise for a rotation. Of each direction:
///
/// - share: of the points, those whose normal sees that motion, |n . m| > |m| / 10, over
///   the largest share of the three directions of its kind;
/// - probability: that the information q = sum (n . m)^2 / D is more than noise. Errors of the
///   normals (isotropic, sigma_n) and of the points alone give it the mean
///   E = sum (sigma_n^2 (|m|^2 - (n . m)^2) + sigma_p^2 |w x n|^2) / D and a variance; the
///   direction is informative when its true part q - E exceeds 2 E, taken as normally distributed
///   (after Hatleskog and Alexis, "Probabilistic Degeneracy Detection for Point-to-Plane Error
///   Minimization", 2024).
///
/// - agreement: of the information q, what the robust weights leave.
///
/// The probability, times share * agreement^2 where that is below 1/200 (over 1/200: a handful of
/// points may be wrong together, the sooner the less they agree), scales the information along the
/// direction, and classes it: full above 0.95, none below 0.05, which leaves exactly zero. Scaled
/// by f, the information becomes H - (1 - f) x x^T / (v^T S v) with x = (S v, 0): what other
/// directions know by way of v stays. `spread` is that of the
/// errors that points share, in the tangent of PlaneRow; `normal_noise_rad` the standard deviation
/// of a map normal beyond what its fit tells: walls are uneven. The sigma of a direction is that of
/// the scaled information under shared errors; of one without constraint 1e6.
PALOC_EXPORT ObservedDirections observeDirections(std::span<const PlaneRow> rows,
                                                  const Mat6& spread, double normal_noise_rad);

/// The same in two parts. The first is all that takes time and needs no spread.
class PALOC_EXPORT DirectionObserver {
 public:
  /// `worse`, if there is one, is asked of a translation that some 120 rows or fewer tell most of,
  /// which may be wrong together, at the edge of a shelf: it is none where the scan would lie
  /// better elsewhere; with 50 rows or fewer already where it would not lie clearly worse.
  DirectionObserver(std::span<const PlaneRow> rows, double normal_noise_rad,
                    const MotionCheck& worse = {});
  /// Of the rows as independent ones (leastSquares), nothing scaled down.
  const Mat6& information() const { return geometry_; }
  /// Without their sigmas.
  const std::array<MatchDirection, 6>& directions() const { return directions_; }
  ObservedDirections under(const Mat6& spread) const;

 private:
  Mat6 geometry_;                               // the rows' own information
  std::array<MatchDirection, 6> directions_{};  // without sigmas
};

}  // namespace paloc

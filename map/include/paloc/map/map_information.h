#pragma once

#include <span>
#include <vector>

#include "paloc/core/export.h"
#include "paloc/core/types.h"

namespace paloc {

/// One point of a scan against its plane of the map, linearized in the body frame. The residual is
/// the height over the plane (m), r = n . (T p) - d; to first order r(T (+) delta) = r + J delta
/// with delta = [translation in the body frame (m), rotation on the right (rad)] and J = [n_body,
/// p_body x n_body], since n . R (w x p) = (R^T n) . (w x p) = (p x R^T n) . w.
struct PlaneRow {
  Vec3 normal_body = Vec3::Zero();  ///< unit normal of the plane, in the body frame
  Vec3 point_body = Vec3::Zero();   ///< m
  double residual = 0;              ///< m
  double variance = 1;       ///< of the residual, the point's own part (m2), over its robust weight
  double robust_weight = 1;  ///< 0..1, which is in the variance
  double range_factor = 0;   ///< n . ray: by how much a longer range moves the residual
  double range_variance = 0;  ///< of the point along its ray (m2)
  double normal_sigma = 0;    ///< standard deviation of the normal's direction (rad)
  double surface_sigma = 0;   ///< standard deviation of the map's points about the plane (m)
  int patch = -1;             ///< the plane patch that it lies on, from 0; -1: none

  Vec6 jacobian() const {
    Vec6 j;
    j.head<3>() = normal_body;
    j.tail<3>() = point_body.cross(normal_body);
    return j;
  }
};

/// The errors that points share.
struct SharedErrors {
  std::vector<double>
      patch_variances;      ///< of the bias of each plane patch (m2); empty: no such bias
  double range_bias_m = 0;  ///< standard deviation of the bias of all ranges of the scan
};

/// Normal equations of a scan: information * delta = -gradient, in the tangent of PlaneRow.
struct NormalEquations {
  Mat6 information = Mat6::Zero();
  Vec6 gradient = Vec6::Zero();
};

/// Information and gradient of weighted least squares, the rows taken as independent, in their
/// order: information = J^T D^-1 J, gradient = J^T D^-1 r.
PALOC_EXPORT NormalEquations leastSquares(std::span<const PlaneRow> rows);

/// What shared errors add to the covariance of the gradient of leastSquares() (shared_errors.h):
///
///   G S G^T = sum_k S_k Y_k Y_k^T + range_bias^2 y y^T,
///   Y_k = sum J/D over patch k,   y = sum (n . ray) J/D,
///
/// since a patch's bias enters its rows with 1, that of the range all rows with n . ray. S_k is the
/// patch's variance; or the square of its weighted mean residual where that is beyond three
/// standard deviations: so a wall that was moved since the survey, or was matched with another one,
/// is in the covariance. Every row's patch must have its variance, or be -1.
PALOC_EXPORT Mat6 sharedSpread(std::span<const PlaneRow> rows, const SharedErrors& shared);

/// Gives each row the patch that it lies on and returns the variance of each patch's bias (m2):
/// that of the survey, plane_bias^2, and a quarter of what the mean square thickness of its surface
/// has beyond that of the map's white noise, since where a map is thick, neighbouring planes are
/// wrong together (a map of drifting scans is).
/// Rows share a patch when they lie on the same plane (normal within 12 degrees, height within 10
/// cm) and within `patch_m` of the patch's first row: a wall is one patch however often it is
/// interrupted. Greedy, in order.
PALOC_EXPORT std::vector<double> assignPatches(std::span<PlaneRow> rows, double patch_m,
                                               double plane_bias_m, double map_noise_m);

/// Information of the body tangent [translation in the body frame, rotation] as that of the pose's
/// tangent [position in the map, rotation].
PALOC_EXPORT Mat6 informationInMap(const Mat6& information_body, const Mat3& R_map_body);

}  // namespace paloc

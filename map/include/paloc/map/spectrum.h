#pragma once

#include <span>

#include "paloc/core/export.h"
#include "paloc/core/types.h"

namespace paloc {

/// A point of a scan with the normal of its surface as the scan shows it and as the map has it
/// (body frame, unit vectors, their signs of no meaning).
struct TwoNormals {
  Vec3 point_body = Vec3::Zero();  ///< m
  Vec3 scan_normal = Vec3::Zero();
  Vec3 map_normal = Vec3::Zero();
};

/// The first stage of the paper's degeneracy analysis: how much the directions that a scan fixes by
/// its own surfaces differ from those that it fixes on the map,
///
///   D_e = sum_i (1 / lambda_i) (1 - |e_i . v_i|)^2,
///
/// lambda_i, e_i the eigenpairs of the point-to-plane Hessian H = (1/N) sum J^T J with the scan's
/// normals, v_i the eigenvectors of the same with the map's, J = [n, p x n / L]. Divided by the
/// number N of points, so that density does not count; L is the root mean square distance of the
/// points, so that rotation has no unit either. v_i is the one that has the smallest angle with
/// e_i: pairs are made from the smallest angle on, each vector used once (two eigenvalues of
/// nearly the same size change their order at the least noise). An eigenvalue below 1e-6 counts as
/// that: it would say no more than that.
///
/// Zero where both agree; it grows where they differ along a direction that the scan fixes badly.
/// It is not monotone in how degenerate a place is (an axis that neither fixes turns both ways
/// alike), and says nothing of which direction is open, so it is a figure to report only. NaN with
/// fewer than twelve points.
PALOC_EXPORT double spectrumDifference(std::span<const TwoNormals> points);

}  // namespace paloc

#pragma once

#include <Eigen/Core>

#include "paloc/core/pose.h"

namespace paloc {

/// One point of a scan against its plane: the residual n . (y - c), y the point in the odom frame.
struct PointToPlane {
  Vec3 normal = Vec3::Zero();  ///< n, odom frame, unit
  Vec3 lever = Vec3::Zero();   ///< R_S u: what turns with the body (m), odom frame
  double age_s = 0;            ///< tau: how long before the end of the scan
  double residual = 0;         ///< m
};

using Vec9 = Eigen::Matrix<double, 9, 1>;
using Mat9 = Eigen::Matrix<double, 9, 9>;

/// Derivative of the residual by [position, rotation on the left, velocity] at the scan's end, all
/// in the odom frame: y = p - v tau + g tau^2 / 2 + R u gives [n, (R u) x n, -tau n]. `ageing` is 0
/// where the velocity is not to be found from the scan's distortion, else 1.
inline Vec9 jacobianOf(const PointToPlane& row, double ageing) {
  Vec9 j;
  j << row.normal, row.lever.cross(row.normal), -ageing * row.age_s * row.normal;
  return j;
}

/// Normal equations of the points of a scan, and what the noise of the planes' normals alone would
/// give as information: with an isotropic error of variance s^2 (rad^2) of a normal, the sum of
/// w s^2 G^T (1 - n n^T) G, G the derivative of the point's position (after Hatleskog and Alexis,
/// "Probabilistic Degeneracy Detection for Point-to-Plane Error Minimization", 2024).
struct PALOC_EXPORT PointToPlaneSums {
  Mat9 information = Mat9::Zero();
  Vec9 gradient = Vec9::Zero();

  void add(const PointToPlane& row, double weight, double ageing) {
    const Vec9 j = jacobianOf(row, ageing);
    information.noalias() += (weight * j) * j.transpose();
    gradient += (weight * row.residual) * j;
  }
  /// Of the noise of normals.
  void addNormalNoise(const PointToPlane& row, double weight, double normal_variance,
                      double ageing);
};

/// The directions (9 x k, orthonormal columns) of which a scan says no more than noise would.
using NullDirections = Eigen::Matrix<double, 9, Eigen::Dynamic, 0, 9, 9>;

/// Takes out of equations what noise pretends to know. Along the bare walls of a corridor or a
/// stairwell the errors of thousands of normals look like information on the open axis; worse, as
/// new points lie on the side of voxels that the body moves to, they hold it back.
///
/// Open directions of the position and of the rotation alone are looked for first: a joint null
/// vector of an open position has small parts of well-known rotation in it, by noise, and what is
/// left across it would still tie the position down. What is open jointly only, as a turn about the
/// axis of a circular hall, is taken out of the information, but is not among `open()`.
class PALOC_EXPORT InformativePart {
 public:
  /// `information`, and `noise`: what the noise of normals would give. A direction is open where
  /// their ratio is below 10; elsewhere the information is scaled by what stands out, 1 - 10 /
  /// ratio.
  InformativePart(const Mat9& information, const Mat9& noise);

  /// Scales normal equations. Where nothing is scaled away, a step stays the same.
  void apply(PointToPlaneSums& sums) const;

  const NullDirections& open() const { return open_; }

 private:
  void addOpen(const Vec9& direction);
  void findOpen(const Mat9& information, const Mat9& noise, int at, double floor);

  NullDirections open_{9, 0};
  Mat9 projector_;  // on what is known of single blocks
  Mat9 root_;       // of the scaling, applied from both sides
};

}  // namespace paloc

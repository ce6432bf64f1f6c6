#pragma once

#include <Eigen/Core>
#include <algorithm>

#include "paloc/core/pose.h"

namespace paloc {

/// One point of a scan against its plane: the residual n . (y - c), y the point in the odom frame.
struct PointToPlane {
  Vec3 normal = Vec3::Zero();  ///< n, odom frame, unit
  Vec3 lever = Vec3::Zero();   ///< R_S u: what turns with the body (m), odom frame
  double age_s = 0;            ///< tau: how long before the end of the scan
  double sag_s2 = 0;           ///< s of ChordMotion, where that is the state
  double residual = 0;         ///< m
};

using Vec9 = Eigen::Matrix<double, 9, 1>;
using Mat9 = Eigen::Matrix<double, 9, 9>;

/// Derivative of the residual by the motion at the scan's end, all in the odom frame: [position,
/// rotation on the left, velocity] where N is 9, the body's rotation during the scan being known;
/// [position, rotation, velocity, rate, acceleration, angular acceleration] where N is 18. With
/// y = p - v tau - a s + R_tau q, s the sag, R_tau the rotation at the point's time, R_tau q its
/// lever, and m = lever x n: [n, m, -tau n, -tau m, -s n, -s m]. `ageing` is 0 where the velocity
/// is not to be found from the scan's distortion, else 1.
template <int N>
Eigen::Matrix<double, N, 1> jacobianOf(const PointToPlane& row, double ageing) {
  static_assert(N == 9 || N == 18);
  Eigen::Matrix<double, N, 1> j;
  j.template head<3>() = row.normal;
  j.template segment<3>(3) = row.lever.cross(row.normal);
  constexpr int kOfVelocity = std::min(6, N - 6);
  j.template segment<kOfVelocity>(6) = -ageing * row.age_s * j.template head<kOfVelocity>();
  if constexpr (N == 18) j.template tail<6>() = -ageing * row.sag_s2 * j.template head<6>();
  return j;
}

/// Normal equations of the points of a scan, and what the noise of the planes' normals alone would
/// give as information: with an isotropic error of variance s^2 (rad^2) of a normal, the sum of
/// w s^2 G^T (1 - n n^T) G, G the derivative of the point's position (after Hatleskog and Alexis,
/// "Probabilistic Degeneracy Detection for Point-to-Plane Error Minimization", 2024).
template <int N>
struct PointToPlaneSums {
  using Vector = Eigen::Matrix<double, N, 1>;
  using Matrix = Eigen::Matrix<double, N, N>;

  Matrix information = Matrix::Zero();
  Vector gradient = Vector::Zero();

  void add(const PointToPlane& row, double weight, double ageing);
  /// Of the noise of normals.
  void addNormalNoise(const PointToPlane& row, double weight, double normal_variance,
                      double ageing);

 private:
  void addMultiples(const Mat6& of_pose, const PointToPlane& row, double ageing);
};

/// The directions (N x k, orthonormal columns) of which a scan says no more than noise would.
template <int N>
using NullDirections = Eigen::Matrix<double, N, Eigen::Dynamic, 0, N, N>;

/// Takes out of equations what noise pretends to know. Along the bare walls of a corridor or a
/// stairwell the errors of thousands of normals look like information on the open axis; worse, as
/// new points lie on the side of voxels that the body moves to, they hold it back.
///
/// Open directions of the position and of the rotation alone are looked for first: a joint null
/// vector of an open position has small parts of well-known rotation in it, by noise, and what is
/// left across it would still tie the position down. Then those of both together: a turn about the
/// axis of a circular hall.
template <int N>
class InformativePart {
 public:
  using Vector = Eigen::Matrix<double, N, 1>;
  using Matrix = Eigen::Matrix<double, N, N>;

  /// `information`, and `noise`: what the noise of normals would give. A direction is open where
  /// their ratio is below 10; elsewhere the information is scaled by what stands out, 1 - 10 /
  /// ratio.
  InformativePart(const Matrix& information, const Matrix& noise);

  /// Scales normal equations. Where nothing is scaled away, a step stays the same.
  void apply(PointToPlaneSums<N>& sums) const;

  const NullDirections<N>& open() const { return open_; }

 private:
  void addOpen(const Vector& direction);
  template <int Size>
  void findOpen(const Matrix& information, const Matrix& noise, int at, double floor);

  NullDirections<N> open_{N, 0};
  Matrix projector_;  // on what is known
  Matrix root_;       // of the scaling, applied from both sides
};

extern template struct PALOC_EXPORT PointToPlaneSums<9>;
extern template struct PALOC_EXPORT PointToPlaneSums<18>;
extern template class PALOC_EXPORT InformativePart<9>;
extern template class PALOC_EXPORT InformativePart<18>;

}  // namespace paloc

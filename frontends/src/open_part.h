#pragma once

#include <Eigen/QR>

namespace paloc {

/// What of an error goes with the error along the directions E (D x k) that a scan leaves open, as
/// a matrix (D x D): P E (E^T P E)^-1 E^T, P the covariance before the scan. It is the regression
/// of the error on E^T error; what is left of the error is not correlated with that. The scan is to
/// tell what is left, and only that (after S. F. Schmidt's consider states).
template <int D, class Columns>
Eigen::Matrix<double, D, D> openPart(const Eigen::Matrix<double, D, D>& P, const Columns& E) {
  if (E.cols() == 0) return Eigen::Matrix<double, D, D>::Zero();
  const Eigen::Matrix<double, D, Eigen::Dynamic> PE = P * E;
  const Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> along(E.transpose() * PE);
  return PE * along.pseudoInverse() * E.transpose();
}

}  // namespace paloc

#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>

namespace paloc {

/// W with W^T W = covariance^-1, upper triangular. The covariance must be positive definite.
template <int N, int Options>
Eigen::Matrix<double, N, N> sqrtInformationOfCovariance(
    const Eigen::Matrix<double, N, N, Options>& covariance) {
  // cov = L L^T, so cov^-1 = L^-T L^-1 and W = L^-1.
  return covariance.llt().matrixL().solve(Eigen::Matrix<double, N, N>::Identity());
}

/// W with W^T W = information. The information may be rank-deficient: directions without any, and
/// negative rounding errors, become exactly zero.
template <int N, int Options>
Eigen::Matrix<double, N, N> sqrtOfInformation(
    const Eigen::Matrix<double, N, N, Options>& information) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, N, N>> eigen(
      Eigen::Matrix<double, N, N>(0.5 * (information + information.transpose())));
  Eigen::Matrix<double, N, 1> roots;
  const double floor = 1e-14 * std::max(0.0, eigen.eigenvalues()[N - 1]);
  for (int i = 0; i < N; ++i) {
    const double value = eigen.eigenvalues()[i];
    roots[i] = value > floor ? std::sqrt(value) : 0.0;
  }
  return roots.asDiagonal() * eigen.eigenvectors().transpose();
}

}  // namespace paloc

#include "paloc/tools/normalized_errors.h"

#include <Eigen/Cholesky>
#include <cmath>

#include "paloc/tools/error_statistics.h"
#include "paloc/tools/quantile.h"

namespace paloc {
namespace {

constexpr double kChiSquared99 = 16.812;  // of six degrees of freedom

template <int N>
bool normalizedSquare(const Vec6& error, const Mat6& covariance, int offset, double& square) {
  const Eigen::Matrix<double, N, 1> e = error.segment<N>(offset);
  const Eigen::Matrix<double, N, N> block = covariance.block<N, N>(offset, offset);
  const Eigen::LLT<Eigen::Matrix<double, N, N>> llt(block);
  if (!block.allFinite() || llt.info() != Eigen::Success) return false;
  square = e.dot(llt.solve(e));
  return std::isfinite(square);
}

}  // namespace

bool NormalizedErrorSums::add(const Pose& estimate, const Pose& reference, const Mat6& covariance) {
  const Vec6 error = boxminus(reference, estimate);
  double all = 0, position = 0, rotation = 0;
  if (!normalizedSquare<6>(error, covariance, 0, all) ||
      !normalizedSquare<3>(error, covariance, 0, position) ||
      !normalizedSquare<3>(error, covariance, 3, rotation)) {
    return false;
  }
  nees_.push_back(all / 6);
  position_ += position / 3;
  rotation_ += rotation / 3;
  outside_ += all > kChiSquared99 ? 1 : 0;
  position_m_.push_back(error.head<3>().norm());
  rotation_rad_.push_back(error.tail<3>().norm());
  position_trace_ += covariance.diagonal().head<3>().sum();
  rotation_trace_ += covariance.diagonal().tail<3>().sum();
  return true;
}

NormalizedErrors NormalizedErrorSums::result() const {
  NormalizedErrors r;
  r.poses = nees_.size();
  if (nees_.empty()) return r;
  const auto n = static_cast<double>(nees_.size());
  r.pose = errorStatistics(nees_).mean;
  r.pose_p95 = quantile(nees_, 0.95);
  r.position = position_ / n;
  r.rotation = rotation_ / n;
  r.outside_99 = outside_ / n;
  const ErrorStatistics position = errorStatistics(position_m_);
  r.position_rmse_m = position.rmse;
  r.position_max_m = position.max;
  r.rotation_rmse_rad = errorStatistics(rotation_rad_).rmse;
  r.position_sigma_m = std::sqrt(position_trace_ / n);
  r.rotation_sigma_rad = std::sqrt(rotation_trace_ / n);
  return r;
}

}  // namespace paloc

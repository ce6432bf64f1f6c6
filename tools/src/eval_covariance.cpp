#include "paloc/tools/eval_covariance.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "paloc/core/errors.h"
#include "paloc/tools/quantile.h"
#include "paloc/tools/trajectory_association.h"

namespace paloc {
namespace {

constexpr double kChiSquared99 = 16.812;  // of six degrees of freedom

/// The errors of poses, added up one by one.
class Errors {
 public:
  // False if the covariance cannot be used.
  bool add(const Pose& estimate, const Pose& reference, const Mat6& covariance) {
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

  NormalizedErrors result() const {
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

 private:
  template <int N>
  static bool normalizedSquare(const Vec6& error, const Mat6& covariance, int offset,
                               double& square) {
    const Eigen::Matrix<double, N, 1> e = error.segment<N>(offset);
    const Eigen::Matrix<double, N, N> block = covariance.block<N, N>(offset, offset);
    const Eigen::LLT<Eigen::Matrix<double, N, N>> llt(block);
    if (!block.allFinite() || llt.info() != Eigen::Success) return false;
    square = e.dot(llt.solve(e));
    return std::isfinite(square);
  }

  std::vector<double> nees_, position_m_, rotation_rad_;
  double position_ = 0, rotation_ = 0, outside_ = 0;
  double position_trace_ = 0, rotation_trace_ = 0;
};

}  // namespace

EvalCovarianceResult evaluateCovariance(const std::vector<StampedPose>& reference,
                                        const std::vector<CovariantPose>& estimate,
                                        double max_dt_s) {
  EvalCovarianceResult result;
  result.reference_poses = reference.size();
  result.estimate_poses = estimate.size();
  std::vector<StampedPose> poses;
  std::map<TimeNs, const CovariantPose*> rows;
  for (const CovariantPose& row : estimate) {
    poses.push_back(row.pose);
    rows.try_emplace(row.pose.t_ns, &row);  // of two with one stamp the first counts
  }
  const OrderedTrajectory truth = inOrderOfTime(reference), ordered = inOrderOfTime(poses);
  const Association association = associateByTime(ordered.poses, truth.poses, max_dt_s);
  if (association.matched.empty()) {
    throw IoError("no pose of the estimate lies within " + std::to_string(max_dt_s) +
                  " s of one of the reference");
  }
  Errors all;
  std::map<std::string, Errors> by_flag;
  for (const MatchedPose& match : association.matched) {
    const CovariantPose& row = *rows.at(match.t_ns);
    // Matched the other way round: the estimate's stamps are the ones that are kept.
    if (all.add(match.reference, match.estimate, row.covariance)) {
      by_flag[row.flag].add(match.reference, match.estimate, row.covariance);
    } else {
      ++result.unusable;
    }
  }
  result.all = all.result();
  for (const auto& [flag, errors] : by_flag) result.by_flag.emplace(flag, errors.result());
  return result;
}

}  // namespace paloc

#include "paloc/tools/corridor_figures.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

namespace paloc {
namespace {

/// Sums over the poses inside.
class InsideSums {
 public:
  explicit InsideSums(const Vec3& axis) : axis_(axis) {
    const Vec3 other = std::abs(axis.z()) < 0.9 ? Vec3::UnitZ() : Vec3::UnitX();
    across_.row(0) = axis.cross(other).normalized().transpose();
    across_.row(1) = axis.cross(across_.row(0).transpose()).transpose();
  }

  void add(const CorridorPose& pose, CorridorFigures& figures) {
    const Vec3 error = pose.estimate.position - pose.truth.position;
    const Mat3 covariance = pose.covariance.topLeftCorner<3, 3>();
    const double along = axis_.dot(error);
    const Eigen::Vector2d across = across_ * error;
    const Eigen::Matrix2d across_covariance = across_ * covariance * across_.transpose();
    figures.along_at_end_m = std::abs(along);  // the last one stays
    figures.along_max_m = std::max(figures.along_max_m, std::abs(along));
    figures.across_max_m = std::max(figures.across_max_m, across.norm());
    squares_ += across.squaredNorm();
    nees_along_ += along * along / axis_.dot(covariance * axis_);
    nees_across_ += across.dot(across_covariance.ldlt().solve(across)) / 2;
    ++figures.poses;
  }

  void finish(CorridorFigures& figures) const {
    if (figures.poses == 0) return;
    const auto count = static_cast<double>(figures.poses);
    figures.across_rms_m = std::sqrt(squares_ / count);
    figures.nees_along = nees_along_ / count;
    figures.nees_across = nees_across_ / count;
  }

 private:
  Vec3 axis_;
  Eigen::Matrix<double, 2, 3> across_;
  double squares_ = 0, nees_along_ = 0, nees_across_ = 0;
};

Vec3 errorOf(const CorridorPose& pose) { return pose.estimate.position - pose.truth.position; }

}  // namespace

CorridorFigures corridorFigures(const std::vector<CorridorPose>& poses,
                                const FreeStretch& stretch) {
  CorridorFigures figures;
  InsideSums sums(stretch.axis_map);
  std::size_t last_inside = 0;
  for (std::size_t k = 0; k < poses.size(); ++k) {
    const CorridorPose& pose = poses[k];
    const bool inside = stretch.holds(pose.truth.position);
    ++(inside ? figures.inside : figures.outside)[static_cast<std::size_t>(pose.flag)];
    const double variance =
        stretch.axis_map.dot(pose.covariance.topLeftCorner<3, 3>() * stretch.axis_map);
    figures.along_max_sigmas =
        std::max(figures.along_max_sigmas,
                 std::abs(stretch.axis_map.dot(errorOf(pose))) / std::sqrt(variance));
    if (!inside) continue;
    sums.add(pose, figures);
    last_inside = k;
  }
  sums.finish(figures);
  for (std::size_t k = last_inside + 1; k < poses.size(); ++k) {
    figures.exit_step_m =
        std::max(figures.exit_step_m, (errorOf(poses[k]) - errorOf(poses[k - 1])).norm());
  }
  return figures;
}

double odometryDrift(const std::vector<Pose>& truth, const std::vector<Pose>& odometry,
                     const FreeStretch& stretch) {
  const auto inside = [&](const Pose& pose) { return stretch.holds(pose.position); };
  const auto first = std::find_if(truth.begin(), truth.end(), inside);
  const auto last = std::find_if(truth.rbegin(), truth.rend(), inside);
  if (first == truth.end()) return 0;
  const auto begin = static_cast<std::size_t>(first - truth.begin());
  const auto end = static_cast<std::size_t>(truth.rend() - last) - 1;
  const Pose T_map_odom = truth[begin] * odometry[begin].inverse();
  return std::abs(
      stretch.axis_map.dot((T_map_odom * odometry[end]).position - truth[end].position));
}

}  // namespace paloc

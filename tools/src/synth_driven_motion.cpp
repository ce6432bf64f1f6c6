#include <algorithm>
#include <cmath>

#include "paloc/core/errors.h"
#include "paloc/frontends/tum_file.h"
#include "paloc/tools/synth_walk.h"

namespace paloc::synth {
namespace {

constexpr double kControlInterval = 0.05;  // s

/// The given poses, straight between neighbours, at a uniform interval.
std::vector<Pose> resampled(const std::vector<StampedPose>& given) {
  const double duration = secondsBetween(given.front().t_ns, given.back().t_ns);
  const auto count = static_cast<std::size_t>(duration / kControlInterval) + 1;
  std::vector<Pose> poses;
  std::size_t next = 1;
  for (std::size_t i = 0; i < count; ++i) {
    const TimeNs t = given.front().t_ns + nsFromSeconds(static_cast<double>(i) * kControlInterval);
    while (next + 1 < given.size() && given[next].t_ns < t) ++next;
    const StampedPose &from = given[next - 1], &to = given[next];
    const double ratio = secondsBetween(from.t_ns, t) / secondsBetween(from.t_ns, to.t_ns);
    poses.push_back(interpolate(from.pose, to.pose, std::clamp(ratio, 0.0, 1.0)));
  }
  return poses;
}

/// Gaussian mean of the neighbours: positions, and rotations in the tangent space of the middle
/// one.
std::vector<Pose> smoothed(const std::vector<Pose>& poses, double sigma_s) {
  const auto n = static_cast<long>(poses.size());
  const long reach = std::lround(3 * sigma_s / kControlInterval);
  std::vector<Pose> result;
  for (long i = 0; i < n; ++i) {
    Vec6 sum = Vec6::Zero();
    double weights = 0;
    for (long k = -reach; k <= reach; ++k) {
      const double x = static_cast<double>(k) * kControlInterval / std::max(sigma_s, 1e-9);
      const double weight = std::exp(-x * x / 2);
      const Pose& pose = poses[static_cast<std::size_t>(std::clamp(i + k, 0L, n - 1))];
      sum += weight * boxminus(pose, poses[static_cast<std::size_t>(i)]);
      weights += weight;
    }
    result.push_back(boxplus(poses[static_cast<std::size_t>(i)], Vec6(sum / weights)));
  }
  return result;
}

}  // namespace

DrivenMotion motionFromFile(const std::filesystem::path& file, double smoothing_s) {
  const std::vector<StampedPose> given = readTum(file);
  if (given.size() < 2) throw IoError(file.string() + ": a path needs two poses or more");
  double longest_gap = 0;
  for (std::size_t i = 1; i < given.size(); ++i) {
    if (given[i].t_ns <= given[i - 1].t_ns) {
      throw IoError(file.string() + ": pose " + std::to_string(i + 1) +
                    " is not later than the one before");
    }
    longest_gap = std::max(longest_gap, secondsBetween(given[i - 1].t_ns, given[i].t_ns));
  }
  DrivenMotion driven{
      Motion(smoothed(resampled(given), smoothing_s), kControlInterval, given.front().t_ns)};
  driven.longest_gap_s = longest_gap;
  double sum_sq = 0;
  for (const StampedPose& pose : given) {
    const Vec3 at = driven.motion.at(pose.t_ns).T_map_body.position;
    const double deviation = (at - pose.pose.position).norm();
    sum_sq += deviation * deviation;
    driven.deviation_max_m = std::max(driven.deviation_max_m, deviation);
  }
  driven.deviation_rms_m = std::sqrt(sum_sq / static_cast<double>(given.size()));
  return driven;
}

}  // namespace paloc::synth

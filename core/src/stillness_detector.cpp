#include "paloc/core/stillness_detector.h"

#include <cmath>

namespace paloc {
namespace {

constexpr double kCoveredShare = 0.8;  // of the window that data must span to be judged by
constexpr std::size_t kMinSamples = 10;

double spread(const Vec3& sum, double sum_sq, double count) {
  return std::sqrt(std::max(0.0, sum_sq / count - (sum / count).squaredNorm()));
}

}  // namespace

void StillnessDetector::addImu(const ImuSample& sample) { samples_.push_back(sample); }

void StillnessDetector::addOdometry(TimeNs t_ns, const Pose& T_odom_body, bool continues) {
  if (!continues) odometry_.clear();
  odometry_.push_back({t_ns, T_odom_body});
  odometry_seen_ = odometry_seen_ || continues;
}

bool StillnessDetector::update(TimeNs t_ns, const Vec3& bias_gyro) {
  judged_ns_ = t_ns;
  forgetBefore(t_ns - nsFromSeconds(settings_.window_s));
  const double ratio = at_rest_ ? settings_.leave_ratio : 1.0;
  at_rest_ =
      settings_.enabled && imuAllowsRest(t_ns, bias_gyro, ratio) && odometryAllowsRest(ratio);
  return at_rest_;
}

bool StillnessDetector::imuAllowsRest(TimeNs t_ns, const Vec3& bias_gyro, double ratio) const {
  Vec3 force = Vec3::Zero(), rate = Vec3::Zero();
  double force_sq = 0, rate_sq = 0;
  std::size_t count = 0;
  for (const ImuSample& s : samples_) {
    if (s.t_ns > t_ns) break;
    // About the first sample: gravity would drown the spread in rounding otherwise.
    const Vec3 f = s.acc_body - samples_.front().acc_body;
    force += f;
    force_sq += f.squaredNorm();
    rate += s.omega_body;
    rate_sq += s.omega_body.squaredNorm();
    ++count;
  }
  if (count < kMinSamples) return false;
  const double covered = secondsBetween(samples_.front().t_ns, t_ns);
  if (covered < kCoveredShare * settings_.window_s) return false;
  const auto n = static_cast<double>(count);
  return spread(force, force_sq, n) <= ratio * settings_.max_force_deviation_mps2 &&
         spread(rate, rate_sq, n) <= ratio * settings_.max_rate_deviation_radps &&
         (rate / n - bias_gyro).norm() <= ratio * settings_.max_mean_rate_radps;
}

// Where there never was an odometry the IMU decides alone; where there is one, it must cover the
// window.
bool StillnessDetector::odometryAllowsRest(double ratio) const {
  if (!odometry_seen_) return true;
  const double covered = secondsBetween(odometry_.front().t_ns, odometry_.back().t_ns);
  if (covered < kCoveredShare * settings_.window_s) return false;
  const Vec6 moved = boxminus(odometry_.back().T_odom_body, odometry_.front().T_odom_body);
  return moved.head<3>().norm() <= ratio * settings_.max_odometry_speed_mps * covered &&
         moved.tail<3>().norm() <= ratio * settings_.max_odometry_rate_radps * covered;
}

std::optional<Vec3> StillnessDetector::meanForce(TimeNs since_ns) const {
  Vec3 sum = Vec3::Zero();
  double count = 0;
  for (const ImuSample& s : samples_) {
    if (s.t_ns < since_ns || s.t_ns > judged_ns_) continue;
    sum += s.acc_body;
    count += 1;
  }
  if (count == 0) return std::nullopt;
  return sum / count;
}

void StillnessDetector::forgetBefore(TimeNs t_ns) {
  while (!samples_.empty() && samples_.front().t_ns < t_ns) samples_.pop_front();
  while (odometry_.size() > 1 && odometry_[1].t_ns <= t_ns) odometry_.pop_front();
}

}  // namespace paloc

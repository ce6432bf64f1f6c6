#include "scan_inertia.h"

#include <algorithm>

#include "paloc/core/stillness_detector.h"

namespace paloc {
namespace {

constexpr int kMotionSteps = 32;  // poses that stand for the motion in a scan
// What an IMU may feel at rest: standard deviations over a scan, mean rate.
constexpr double kRestForce = 0.15, kRestRate = 0.02, kRestMeanRate = 0.03;  // m/s2, rad/s, rad/s
// What a body may do where no IMU tells: white noise, as densities.
constexpr double kUnknownForce = 1.5, kUnknownRate = 0.7;  // m/s2/sqrt(Hz), rad/s/sqrt(Hz)

bool isAtRest(const ImuBuffer& imu, TimeNs start_ns, TimeNs end_ns) {
  StillnessSettings settings;
  settings.window_s = secondsBetween(start_ns, end_ns);
  settings.max_force_deviation_mps2 = kRestForce;
  settings.max_rate_deviation_radps = kRestRate;
  settings.max_mean_rate_radps = kRestMeanRate;
  StillnessDetector detector(settings);
  for (const ImuSample& sample : imu.between(start_ns, end_ns)) detector.addImu(sample);
  return detector.update(end_ns, Vec3::Zero());
}

// A body that moves evenly between two instants, as an IMU with the biases of the state feels it.
ImuBuffer evenMotion(const LioState& x, const Vec3& omega_body, TimeNs start_ns, TimeNs end_ns) {
  const Vec3 force = x.bias_acc - x.T_odom_body.rotation.transpose() * x.gravity_odom;
  ImuBuffer imu;
  imu.add({start_ns, force, omega_body});
  imu.add({std::max(end_ns, start_ns + 1), force, omega_body});
  return imu;
}

}  // namespace

ScanMotion motionDuring(const KeptScan& scan, const LioState& x) {
  ScanMotionInput input;
  input.start_ns = scan.start_ns;
  input.end_ns = scan.end_ns;
  for (int i = 0; i <= kMotionSteps; ++i) {
    const TimeNs t_ns = scan.start_ns + (scan.end_ns - scan.start_ns) * i / kMotionSteps;
    const double tau = secondsBetween(t_ns, scan.end_ns);
    Pose pose = x.T_odom_body * scan.fall->bodyAt(tau);
    pose.position += tau * (0.5 * tau * x.gravity_odom - x.v_odom);
    input.odometry.push_back({t_ns, pose});
  }
  return ScanMotion(input);
}

std::optional<FirstScan> firstScan(ScanTimes scan, const ImuBuffer& imu,
                                   const FrontendSettings& settings, const LioState& x) {
  const TimeNs end_ns = scan.end_ns;
  // A scan without duration has the force of the moment before it.
  const TimeNs start_ns = std::min(scan.start_ns, end_ns - nsFromSeconds(0.02));
  const auto mean = imu.integrate(start_ns, end_ns, settings.max_imu_gap_s, settings.imu_noise,
                                  x.bias_acc, x.bias_gyro);
  if (!mean || mean->delta_v.norm() == 0) return std::nullopt;
  FirstScan first;
  first.scan = {scan, FreeFallScan(imu, scan.start_ns, end_ns, settings.max_imu_gap_s, x.bias_acc,
                                   x.bias_gyro)};
  if (!first.scan.fall->ok()) return std::nullopt;
  first.up_body = (mean->delta_R.transpose() * mean->delta_v).normalized();
  first.at_rest = isAtRest(imu, start_ns, end_ns);
  return first;
}

void ScanInertia::follow(ScanTimes scan, const ImuBuffer& imu, TimeNs last_ns, const LioState& x) {
  const TimeNs end_ns = scan.end_ns;
  scan_ = {scan, FreeFallScan(imu, scan.start_ns, end_ns, settings_.max_imu_gap_s, x.bias_acc,
                              x.bias_gyro)};
  noise_ = settings_.imu_noise;
  motion_ =
      imu.integrate(last_ns, end_ns, settings_.max_imu_gap_s, noise_, x.bias_acc, x.bias_gyro);
  measured_ = motion_ && scan_.fall->ok();
  if (measured_) {
    const auto samples = imu.between(last_ns, end_ns);
    if (!samples.empty()) last_rate_body_ = samples.back().omega_body;
    return;
  }
  ++without_;
  const TimeNs from_ns = std::min(last_ns, scan.start_ns);
  const ImuBuffer even = evenMotion(x, last_rate_body_, from_ns, end_ns);
  const double any_gap_s = secondsBetween(from_ns, end_ns) + 1;
  noise_.accelerometer_noise_density_mps2_sqrthz = kUnknownForce;
  noise_.gyroscope_noise_density_radps_sqrthz = kUnknownRate;
  scan_.fall.emplace(even, scan.start_ns, end_ns, any_gap_s, x.bias_acc, x.bias_gyro);
  motion_ = even.integrate(last_ns, end_ns, any_gap_s, noise_, x.bias_acc, x.bias_gyro);
}

}  // namespace paloc

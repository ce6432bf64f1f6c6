#include "lio_tracker.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "paloc/core/stillness_detector.h"

namespace paloc {
namespace {

constexpr double kLeastMatched = 0.1;  // of the points: fewer, and the scan is not used
constexpr int kMotionSteps = 32;       // poses that stand for the motion in a scan
// What an IMU may feel at rest (standard deviations over a scan, mean rate), and how sure rest is.
constexpr double kRestForce = 0.15, kRestRate = 0.02, kRestMeanRate = 0.03;  // m/s2, rad/s, rad/s
constexpr double kRestSpeed = 0.1, kRestAcceleration = 0.03;                 // m/s, m/s2
// What a body may do where no IMU tells: white noise, as densities.
constexpr double kUnknownForce = 1.5, kUnknownRate = 0.7;  // m/s2/sqrt(Hz), rad/s/sqrt(Hz)
// How wrong is then what a scan tells, whose shape nothing corrects: as if half of it were turned
// by half a radian a second. It does not go into the map.
constexpr double kBlindPosition = 0.05, kBlindRotation = 0.025, kBlindVelocity = 0.5;  // m rad m/s

// Up follows from the mean force f = b_a + R^T (a - g) of the first scan, so the error of g is that
// of the bias, R db_a, and the body's acceleration. In g's tangent space it is B^T (g x dg) / g^2.
LioMatrix firstCovariance(const FastLioSettings& s, const LioState& x, bool at_rest) {
  LioVector sigma = LioVector::Zero();
  sigma.segment<3>(lio::kVelocity).setConstant(at_rest ? kRestSpeed : s.sigma_velocity_mps);
  sigma.segment<3>(lio::kBiasAcc).setConstant(s.sigma_bias_acc_mps2);
  sigma.segment<3>(lio::kBiasGyro).setConstant(s.sigma_bias_gyro_radps);
  LioMatrix covariance = sigma.cwiseAbs2().asDiagonal();
  const Vec3& g = x.gravity_odom;
  const Eigen::Matrix<double, 2, 3> by_gravity =
      tangentBasis(g).transpose() * so3::hat(g) / g.squaredNorm();
  const Eigen::Matrix<double, 2, 3> by_bias = by_gravity * x.T_odom_body.rotation;
  const double acceleration = at_rest ? kRestAcceleration : s.sigma_acceleration_mps2;
  const double bias_variance = s.sigma_bias_acc_mps2 * s.sigma_bias_acc_mps2;
  covariance.block<2, 2>(lio::kGravity, lio::kGravity) =
      bias_variance * by_bias * by_bias.transpose() +
      acceleration * acceleration * by_gravity * by_gravity.transpose();
  covariance.block<2, 3>(lio::kGravity, lio::kBiasAcc) = bias_variance * by_bias;
  covariance.block<3, 2>(lio::kBiasAcc, lio::kGravity) = bias_variance * by_bias.transpose();
  return covariance;
}

// Whether the IMU feels nothing but gravity and its biases.
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

LioTracker::LioTracker(const FrontendSettings& settings)
    : settings_(settings),
      filter_({settings.fast_lio.max_iterations, settings.fast_lio.noise_floor_m,
               settings.fast_lio.max_gate_m}),
      map_({settings.fast_lio.voxel_m, settings.fast_lio.level_factor, settings.fast_lio.levels,
            static_cast<std::size_t>(settings.fast_lio.max_voxels),
            settings.fast_lio.max_distance_m}) {}

LioTracker::Outcome LioTracker::add(const LidarFrame& frame, const ImuBuffer& imu, bool has_times) {
  sensor_body_ = frame.T_body_lidar.position;
  const double pause_s = secondsBetween(scan_.end_ns, frame.stamp_ns);
  if (!begun_ || pause_s > settings_.fast_lio.max_gap_s || filter_.isLost()) {
    return begin(frame, imu, has_times);
  }
  predict(frame, imu);
  selectPoints(frame, has_times);
  if (!first_.points.empty()) startMoving();
  const std::size_t matched = update();
  worst_imu_noise_ = std::max(worst_imu_noise_, std::sqrt(filter_.imuFactor()));
  if (!inertial_) filter_.blur(kBlindPosition, kBlindRotation, kBlindVelocity);
  const bool used =
      static_cast<double>(matched) >= kLeastMatched * static_cast<double>(points_.size()) &&
      !points_.empty();
  StageScope stage(timer_, "map update");
  if (inertial_) addToMap(map_points_, scan_);
  return used ? Outcome::kTracked : Outcome::kCoasted;
}

// The body's velocity is taken as zero until the second scan tells; up is where the mean force
// points.
LioTracker::Outcome LioTracker::begin(const LidarFrame& frame, const ImuBuffer& imu,
                                      bool has_times) {
  const TimeNs end_ns = frame.endNs();
  LioState state = begun_ ? filter_.state() : LioState{};
  begun_ = false;
  // A scan without duration has the force of the moment before it.
  const TimeNs start_ns = std::min(frame.stamp_ns, end_ns - nsFromSeconds(0.02));
  const auto mean = imu.integrate(start_ns, end_ns, settings_.max_imu_gap_s, settings_.imu_noise,
                                  state.bias_acc, state.bias_gyro);
  if (!mean || mean->delta_v.norm() == 0) return Outcome::kNoInertia;
  scan_ = {frame.stamp_ns, end_ns,
           FreeFallScan(imu, frame.stamp_ns, end_ns, settings_.max_imu_gap_s, state.bias_acc,
                        state.bias_gyro)};
  if (!scan_.fall->ok()) return Outcome::kNoInertia;
  begun_ = true;
  const Vec3 up_body = (mean->delta_R.transpose() * mean->delta_v).normalized();
  state.v_odom = Vec3::Zero();
  state.gravity_odom = -settings_.gravity_mps2 * (state.T_odom_body.rotation * up_body);
  filter_.begin(state, firstCovariance(settings_.fast_lio, state, isAtRest(imu, start_ns, end_ns)));
  map_.clear();
  selectPoints(frame, has_times);
  addToMap(map_points_, scan_, true);
  first_ = {scan_, state, map_points_};
  return Outcome::kBegun;
}

void LioTracker::predict(const LidarFrame& frame, const ImuBuffer& imu) {
  const LioState& x = filter_.state();
  const TimeNs last_ns = scan_.end_ns, end_ns = frame.endNs();
  scan_ = {
      frame.stamp_ns, end_ns,
      FreeFallScan(imu, frame.stamp_ns, end_ns, settings_.max_imu_gap_s, x.bias_acc, x.bias_gyro)};
  const auto measured = imu.integrate(last_ns, end_ns, settings_.max_imu_gap_s, settings_.imu_noise,
                                      x.bias_acc, x.bias_gyro);
  inertial_ = measured && scan_.fall->ok();
  if (inertial_) {
    const auto samples = imu.between(last_ns, end_ns);
    if (!samples.empty()) last_rate_body_ = samples.back().omega_body;
    return filter_.predict(*measured, settings_.imu_noise);
  }
  ++intervals_without_imu_;
  const TimeNs from_ns = std::min(last_ns, frame.stamp_ns);
  const ImuBuffer even = evenMotion(x, last_rate_body_, from_ns, end_ns);
  const double any_gap_s = secondsBetween(from_ns, end_ns) + 1;
  ImuNoise noise = settings_.imu_noise;
  noise.accelerometer_noise_density_mps2_sqrthz = kUnknownForce;
  noise.gyroscope_noise_density_radps_sqrthz = kUnknownRate;
  scan_.fall.emplace(even, frame.stamp_ns, end_ns, any_gap_s, x.bias_acc, x.bias_gyro);
  filter_.predict(*even.integrate(last_ns, end_ns, any_gap_s, noise, x.bias_acc, x.bias_gyro),
                  noise);
}

// At the second scan: finds the velocity, and makes the map of the first scan anew with it.
void LioTracker::startMoving() {
  const LioFilter predicted = filter_;
  update(true);
  const Vec3 v = filter_.state().v_odom - predicted.state().v_odom;
  const double dt_s = secondsBetween(first_.scan.end_ns, scan_.end_ns);
  first_.state.v_odom += v;
  LioState moved = predicted.state();
  moved.v_odom += v;
  moved.T_odom_body.position += dt_s * v;
  filter_.restart(first_.state);
  map_.clear();
  addToMap(std::exchange(first_.points, {}), first_.scan);
  filter_ = predicted;
  filter_.restart(moved);
}

std::size_t LioTracker::update(bool rigid) {
  StageScope stage(timer_, "registration");
  return filter_.update(points_, *scan_.fall, sensor_body_, map_, rigid);
}

void LioTracker::addToMap(const std::vector<MeasuredPoint>& points, const KeptScan& scan,
                          bool rigid) {
  for (const PlacedPoint& p : filter_.place(points, *scan.fall, sensor_body_, rigid)) {
    map_.add(p.point_odom, p.ray);
  }
  map_.endScan(filter_.state().T_odom_body.position);
}

// Points for the map, spread evenly over the surfaces, and every so many-th of them to register.
void LioTracker::selectPoints(const LidarFrame& frame, bool has_times) {
  StageScope stage(timer_, "thinning");
  map_points_.clear();
  points_.clear();
  const double min_sq = settings_.min_range_m * settings_.min_range_m;
  const double max_sq = settings_.max_range_m * settings_.max_range_m;
  const double duration_s = secondsBetween(0, frame.duration_ns);
  const auto wanted_for_map = static_cast<std::size_t>(settings_.fast_lio.map_points);
  for (const std::uint32_t i : thinning_.select(frame.points_lidar, Vec3::Zero(), wanted_for_map)) {
    const Point3f& p = frame.points_lidar[i];
    const Vec3 point(static_cast<double>(p.x), static_cast<double>(p.y), static_cast<double>(p.z));
    const double sq = point.squaredNorm();
    if (sq < min_sq || sq > max_sq) continue;
    map_points_.push_back(
        {frame.T_body_lidar * point,
         has_times ? duration_s - 1e-9 * static_cast<double>(frame.dt_ns[i]) : 0});
  }
  const auto wanted = static_cast<std::size_t>(settings_.fast_lio.registration_points);
  const std::size_t step = std::max<std::size_t>(1, (map_points_.size() + wanted / 2) / wanted);
  for (std::size_t i = 0; i < map_points_.size(); i += step) points_.push_back(map_points_[i]);
}

ScanMotion LioTracker::motionDuring(const KeptScan& scan, const LioState& x) {
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

}  // namespace paloc

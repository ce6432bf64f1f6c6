#include "lio_tracker.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "calibration_report.h"

namespace paloc {
namespace {

constexpr double kLeastMatched = 0.1;  // of the points: fewer, and the scan is not used
// Of the time from scan to scan: by more the stamps are not shifted at once, so that no time runs
// backwards.
constexpr double kMostShift = 0.25;

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

}  // namespace

LioTracker::LioTracker(const FrontendSettings& settings)
    : InertialTracker(settings),
      filter_({settings.fast_lio.max_iterations, settings.local_map.noise_floor_m,
               settings.local_map.max_gate_m}),
      map_(settings.local_map),
      selection_(settings) {
  const FastLioSettings& s = settings.fast_lio;
  if (s.estimate_extrinsic || s.estimate_time_offset) filter_.calibrate(CalibrationBlock(s));
}

LioTracker::Outcome LioTracker::add(const LidarFrame& frame, const ImuBuffer& imu, bool has_times) {
  T_body_lidar_ = frame.T_body_lidar;
  const TimeNs before_ns = scan_.end_ns;
  const Outcome outcome = track(frame, imu, has_times);
  T_odom_body_ = filter_.odometryPose();
  if (outcome == Outcome::kTracked) shiftStamps(secondsBetween(before_ns, scan_.end_ns));
  return outcome;
}

LioTracker::Outcome LioTracker::track(const LidarFrame& frame, const ImuBuffer& imu,
                                      bool has_times) {
  const ScanTimes times = timesOf(frame, imu_late_ns_);
  const double pause_s = secondsBetween(scan_.end_ns, times.start_ns);
  if (!begun_ || pause_s > settings_.local_map.max_gap_s || filter_.isLost()) {
    return begin(frame, imu, has_times);
  }
  inertia_.follow(times, imu, scan_.end_ns, filter_.state());
  scan_ = inertia_.scan();
  filter_.predict(inertia_.motion(), inertia_.noise());
  selectPoints(frame, has_times);
  if (!first_.points.empty()) startMoving();
  const std::size_t matched = update();
  keepWorst(filter_.imuFactor());
  if (!inertia_.measured()) filter_.blur(kBlindPosition, kBlindRotation, kBlindVelocity);
  const bool used =
      static_cast<double>(matched) >= kLeastMatched * static_cast<double>(points_.size()) &&
      !points_.empty();
  StageScope stage(timer_, "map update");
  if (inertia_.measured()) addToMap(map_points_, scan_);
  return used ? Outcome::kTracked : Outcome::kCoasted;
}

// The body's velocity is taken as zero until the second scan tells; up is where the mean force
// points.
LioTracker::Outcome LioTracker::begin(const LidarFrame& frame, const ImuBuffer& imu,
                                      bool has_times) {
  LioState state = begun_ ? filter_.state() : LioState{};
  begun_ = false;
  const auto first = firstScan(timesOf(frame, imu_late_ns_), imu, settings_, state);
  if (!first) return Outcome::kRefused;
  scan_ = first->scan;
  begun_ = true;
  state.v_odom = Vec3::Zero();
  state.gravity_odom = -settings_.gravity_mps2 * (state.T_odom_body.rotation * first->up_body);
  const LioMatrix covariance = firstCovariance(settings_.fast_lio, state, first->at_rest);
  if (filter_.calibration()) {
    filter_.begin(state, covariance, T_body_lidar_.position, *scan_.fall);
  } else {
    filter_.begin(state, covariance);
  }
  map_.clear();
  selectPoints(frame, has_times);
  addToMap(map_points_, scan_, true);
  first_ = {scan_, state, map_points_};
  return Outcome::kBegun;
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
  filter_ = predicted;
  filter_.restart(first_.state);
  map_.clear();
  addToMap(std::exchange(first_.points, {}), first_.scan);
  filter_ = predicted;
  filter_.restart(moved);
}

std::size_t LioTracker::update(bool rigid) {
  StageScope stage(timer_, "registration");
  return filter_.update(points_, *scan_.fall, T_body_lidar_.position, map_, rigid);
}

void LioTracker::addToMap(const std::vector<MeasuredPoint>& points, const KeptScan& scan,
                          bool rigid) {
  for (const PlacedPoint& p : filter_.place(points, *scan.fall, T_body_lidar_.position, rigid)) {
    map_.add(p.point_odom, p.ray);
  }
  map_.endScan(filter_.state().T_odom_body.position);
}

// Points for the map, spread evenly over the surfaces, and every so many-th of them to register.
void LioTracker::selectPoints(const LidarFrame& frame, bool has_times) {
  StageScope stage(timer_, "thinning");
  selection_.select(frame, has_times, static_cast<std::size_t>(settings_.fast_lio.map_points),
                    nullptr, map_points_);
  points_ =
      everyNth(map_points_, static_cast<std::size_t>(settings_.local_map.registration_points));
}

// By the LiDAR's clock.
ScanMotion LioTracker::motionOf(const KeptScan& scan, const LioState& x) const {
  if (!filter_.calibration()) return motionDuring(scan, x);
  const CalibrationBlock& block = *filter_.calibration();
  const TimeNs late_ns = nsFromSeconds(block.imuLateS());
  KeptScan by_lidar = scan;
  by_lidar.start_ns -= late_ns;
  by_lidar.end_ns -= late_ns;
  return motionDuring(by_lidar, x);
}

Pose LioTracker::mountOf(const Pose& T_body_lidar) const {
  return filter_.calibration() ? filter_.calibration()->value.corrected(T_body_lidar)
                               : T_body_lidar;
}

void LioTracker::shiftStamps(double scan_interval_s) {
  if (!settings_.fast_lio.estimate_time_offset) return;
  filter_.takeTimeOffset(kMostShift * scan_interval_s);
  imu_late_ns_ = nsFromSeconds(filter_.calibration()->applied_s);
}

std::vector<std::string> LioTracker::notes(int scans) const {
  std::vector<std::string> sentences = InertialTracker::notes(scans);
  if (filter_.calibration() && begun_) {
    for (const std::string& sentence :
         reportOf(*filter_.calibration(), T_body_lidar_, settings_.fast_lio)) {
      sentences.push_back(sentence);
    }
  }
  return sentences;
}

}  // namespace paloc

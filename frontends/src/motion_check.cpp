#include "motion_check.h"

#include <Eigen/Eigenvalues>
#include <cmath>
#include <utility>

namespace paloc {
namespace {

constexpr double kLongestLook = 300;            // s
constexpr std::size_t kMostSequences = 5;       // of 8 s at 10 Hz
constexpr double kShortestOdometryStep = 0.09;  // s: shorter ones are mostly noise
constexpr double kLeastTurn = 0.004;            // rad in a step of 0.1 s, root mean square
constexpr double kMostUnexplained = 0.35;       // of the square turning

// The part of the turn along directions that are known to a third of a degree, or to be far off.
void setRotationError(const TurnFit& fit, MotionComparison& motion) {
  constexpr double kKnown = 0.006, kFarSigmas = 6;  // rad
  const Mat3 R = motion.R_body_sensor;
  const Vec3 error = so3::log(R * motion.R_body_sensor_configured.transpose());
  const Eigen::SelfAdjointEigenSolver<Mat3> eigen(R * fit.rotation_covariance * R.transpose());
  Vec3 known = Vec3::Zero();
  double variance = 0;
  for (int i = 0; i < 3; ++i) {
    const Vec3 axis = eigen.eigenvectors().col(i);
    const double off = axis.dot(error), sigma = std::sqrt(std::max(0.0, eigen.eigenvalues()[i]));
    if (!(sigma < kKnown || std::abs(off) > kFarSigmas * sigma)) continue;
    known += axis * off;
    variance = std::max(variance, sigma * sigma);
  }
  motion.rotation_error_body = known;
  motion.rotation_error_sigma_rad = std::sqrt(variance);
}

// Whether two axes of the sensor turn as the gyroscope says, as configured, and only the third does
// not: then it is the place that leaves this turn open (a round hall, a tunnel).
bool leavesOneTurnOpen(const std::vector<TurnStep>& steps, const GyroTrack& gyro,
                       const Mat3& R_sensor_imu) {
  constexpr double kFits = 0.2;  // of the square turning about the two
  TurnFit configured;
  configured.R_sensor_imu = R_sensor_imu;
  const Eigen::SelfAdjointEigenSolver<Mat3> left(turnResidual(steps, gyro, configured));
  const Vec3 open = left.eigenvectors().col(2);
  double turned = 0;
  for (const TurnStep& step : steps)
    turned += (step.turn - open * open.dot(step.turn)).squaredNorm();
  return left.eigenvalues().head<2>().sum() < kFits * turned / static_cast<double>(steps.size());
}

void setFit(const TurnFit& fit, const std::vector<TurnStep>& steps, const GyroTrack& gyro,
            MotionComparison& motion) {
  constexpr double kObservable = 1e-3;  // s
  motion.steps = fit.steps;
  motion.turn_rms_rad = fit.turn_rms_rad;
  motion.fitted_rms_rad = std::sqrt(turnResidual(steps, gyro, fit).trace());
  TurnFit configured = fit;
  configured.R_sensor_imu = motion.R_body_sensor_configured.transpose();
  motion.configured_rms_rad = std::sqrt(turnResidual(steps, gyro, configured).trace());
  motion.fits = fit.unexplained() < kMostUnexplained;
  motion.gyro_scale = fit.scale;
  motion.gyro_scale_sigma = fit.scale_sigma;
  motion.R_body_sensor = fit.R_sensor_imu.transpose();
  if (motion.R_body_sensor.determinant() > 0) setRotationError(fit, motion);
  motion.offset_s = fit.offset_s;
  motion.offset_sigma_s = fit.offset_sigma_s;
  motion.offset_observable = fit.offset_sigma_s < kObservable;
}

}  // namespace

bool MotionCheck::inTime(TimeNs t_ns) {
  if (!first_ns_) first_ns_ = t_ns;
  return std::abs(secondsBetween(*first_ns_, t_ns)) < kLongestLook;
}

void MotionCheck::addImu(const std::string& label, const ImuSample& sample) {
  imu_label_ = label;
  if (!inTime(sample.t_ns) || (!gyro_.empty() && sample.t_ns <= gyro_.newestNs())) return;
  gyro_.add(sample);
}

void MotionCheck::addOdometry(const std::string& label, const OdometryPose& pose) {
  odometry_label_ = label;
  if (!inTime(pose.t_ns)) return;
  if (!last_pose_) {
    last_pose_ = pose;
    return;
  }
  const double dt_s = secondsBetween(last_pose_->t_ns, pose.t_ns);
  if (dt_s > 0 && dt_s < kShortestOdometryStep) return;
  TurnStep step;
  step.from_ns = last_pose_->t_ns;
  step.to_ns = pose.t_ns;
  step.turn = so3::log(last_pose_->T_odom_body.rotation.transpose() * pose.T_odom_body.rotation);
  const bool one_motion = dt_s > 0 && dt_s <= settings_.max_odometry_gap_s &&
                          step.turn.norm() < settings_.max_odometry_rate_radps * dt_s;
  if (one_motion) odometry_steps_.push_back(step);
  last_pose_ = pose;
}

void MotionCheck::addScan(const LidarFrame& frame) {
  if (!inTime(frame.stamp_ns) || sequences_.size() == kMostSequences) return;
  if (last_scan_ns_ && frame.stamp_ns <= *last_scan_ns_) return;  // comes again
  last_scan_ns_ = frame.stamp_ns;
  has_scans_ = true;
  lidar_label_ = frame.label;
  R_body_lidar_ = frame.T_body_lidar.rotation;
  scan_duration_s_ = secondsBetween(frame.stamp_ns, frame.endNs());
  if (sequence_.add(frame)) return;
  closeSequence();
  sequence_.add(frame);
}

// Keeps a sequence that turns; one that does not is no help.
void MotionCheck::closeSequence() {
  ScanSequence sequence = std::exchange(sequence_, {});
  if (!sequence.track()) return;
  std::vector<TurnStep> steps;
  sequence.appendSteps(steps);
  if (turnRms(steps) > kLeastTurn) sequences_.push_back(std::move(sequence));
}

std::optional<MotionComparison> MotionCheck::compareOdometry() const {
  if (!last_pose_) return std::nullopt;
  MotionComparison motion;
  motion.label = odometry_label_;
  motion.of_odometry = true;
  motion.imu_label = imu_label_;
  motion.turns = turnRms(odometry_steps_) > kLeastTurn;
  if (!motion.turns) return motion;
  const auto fit = findTurnFit(odometry_steps_, gyro_, Mat3::Identity());
  if (!fit) return std::nullopt;
  setFit(*fit, odometry_steps_, gyro_, motion);
  return motion;
}

std::optional<MotionComparison> MotionCheck::compareLidar() {
  if (!has_scans_) return std::nullopt;
  if (sequences_.size() < kMostSequences) closeSequence();
  MotionComparison motion;
  motion.label = lidar_label_;
  motion.imu_label = imu_label_;
  motion.R_body_sensor_configured = R_body_lidar_;
  motion.scan_duration_s = scan_duration_s_;
  motion.turns = !sequences_.empty();
  if (!motion.turns) return motion;
  std::vector<TurnStep> steps;
  for (const ScanSequence& sequence : sequences_) sequence.appendSteps(steps);
  auto fit = findTurnFit(steps, gyro_, R_body_lidar_.transpose());
  if (!fit) return std::nullopt;
  // Anew with scans that the gyroscope has moved: free of the error of taking the motion during a
  // scan as even.
  for (int round = 0; round < 4 && fit->unexplained() < kMostUnexplained; ++round) {
    const GyroTrack in_lidar = gyro_.transformed(fit->scale * fit->R_sensor_imu);
    const TimeNs shift = nsFromSeconds(fit->offset_s);
    steps.clear();
    for (ScanSequence& sequence : sequences_) {
      sequence.trackWith([&](TimeNs from_ns, TimeNs to_ns) {
        return in_lidar.rotation(from_ns + shift, to_ns + shift);
      });
      sequence.appendSteps(steps);
    }
    fit = refineTurnFit(steps, gyro_, *fit, 1);
  }
  setFit(*fit, steps, gyro_, motion);
  motion.one_turn_open = !motion.fits && leavesOneTurnOpen(steps, gyro_, R_body_lidar_.transpose());
  return motion;
}

std::vector<MotionComparison> MotionCheck::compare() {
  std::vector<MotionComparison> comparisons;
  if (gyro_.empty()) return comparisons;
  if (auto lidar = compareLidar()) comparisons.push_back(std::move(*lidar));
  if (auto odometry = compareOdometry()) comparisons.push_back(std::move(*odometry));
  return comparisons;
}

}  // namespace paloc

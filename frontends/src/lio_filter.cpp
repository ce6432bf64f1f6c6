#include "paloc/frontends/lio_filter.h"

#include "lio_update.h"
#include "motion_covariance.h"
#include "points_on_planes.h"
#include "pose_before.h"

namespace paloc {
namespace {

constexpr double kLostSigma_m = 100;
// Scans until a map that begins is good enough to tell the calibration: the first ones lie in it as
// the first guess of the velocity has them.
constexpr int kSettling = 10;
// Of the variance of the IMU's noise (see ImuAgreement): an IMU that disagrees by more with what
// the scans say, whatever the calibration, is not to tell it.
constexpr double kMostImuFactor = 4;
// Normalized squared step of the LiDAR's pose, a degree of freedom, of an update that contradicts
// the prediction (one in a thousand does by chance): it is not to move the calibration.
constexpr double kContradiction = 3.7;

double squaredStep(const CalibratedLioUpdate& update, const CalibratedLioState& prior) {
  const Vec6 step = boxminus(update.state(), prior).head<6>();
  return ImuAgreement::squared(step, update.gained().topLeftCorner<6, 6>());
}

// `settled`: the calibration may be told.
template <class Matches>
bool runOn(Matches& matches, const CalibratedLioState& prior, const CalibratedLioMatrix& covariance,
           double lever_m, bool settled, CalibratedLioUpdate& update) {
  if (!settled) update.considerRest();
  if (!update.run(prior, covariance, lever_m, matches, calibratedToMeasured)) return false;
  if (!settled || squaredStep(update, prior) <= kContradiction) return true;
  update.considerRest();
  return update.run(prior, covariance, lever_m, matches, calibratedToMeasured);
}

}  // namespace

void LioFilter::begin(const LioState& state, const LioMatrix& covariance) {
  state_ = state;
  covariance_ = covariance;
}

void LioFilter::begin(const LioState& state, const LioMatrix& covariance, const Vec3& sensor_body,
                      const FreeFallScan& scan) {
  odometry_0_ = odometryPose();
  T_odom_body_0_ = state.T_odom_body;
  begin(state, covariance);
  calibration_->begin(state, SensorMotion(scan, sensor_body), covariance_);
}

Pose LioFilter::odometryPose() const {
  if (!calibration_) return state_.T_odom_body;
  return odometry_0_ * (T_odom_body_0_.inverse() * state_.T_odom_body);
}

void LioFilter::predict(const Preintegration& imu, const ImuNoise& noise) {
  if (calibration_) odometry_0_ = odometryPose();
  T_odom_body_0_ = state_.T_odom_body;
  open_motion_.setIdentity();
  covariance_0_ = covariance_.topLeftCorner<6, 6>();
  const LioMatrix F = lioTransition(state_, imu);
  cross_ = F * covariance_.leftCols<6>();
  if (calibration_) calibration_->predict(state_, F);
  const LioMatrix predicted = F * covariance_ * F.transpose() +
                              agreement_.imuFactor() * lioProcessNoise(state_, imu, noise);
  covariance_ = 0.5 * (predicted + predicted.transpose());
  state_ = predictLio(state_, imu);
}

const std::vector<PlacedPoint>& LioFilter::place(const std::vector<MeasuredPoint>& points,
                                                 const FreeFallScan& scan, const Vec3& sensor_body,
                                                 bool rigid) {
  const double ageing = rigid ? 0 : 1;
  if (calibration_) {
    placePoints(points, scan, sensor_body, calibration_->with(state_), ageing, placed_);
  } else {
    placePoints(points, scan, sensor_body, state_, ageing, placed_);
  }
  return placed_;
}

bool LioFilter::isLost() const {
  const double sigma = displacementSigma<lio::kDim>(covariance_, 0);
  return !(sigma < kLostSigma_m) || !state_.v_odom.allFinite();
}

std::size_t LioFilter::update(const std::vector<MeasuredPoint>& points, const FreeFallScan& scan,
                              const Vec3& sensor_body, const LocalVoxelMap& map, bool rigid) {
  if (calibration_) return updateCalibrated(points, scan, sensor_body, map, rigid);
  const double ageing = rigid ? 0 : 1;
  LioUpdate update({limits_.max_iterations, limits_.max_gate_m});
  const auto place = [&](const LioState& x) -> const std::vector<PlacedPoint>& {
    placePoints(points, scan, sensor_body, x, ageing, placed_);
    return placed_;
  };
  auto matches = pointsOnPlanes<9>(matches_, map, ageing, place);
  if (!update.run(state_, covariance_, rmsRange(points), matches, lioToMeasured)) {
    return matches_.size();
  }
  if (!rigid) {
    agreement_.compare(boxminus(update.state(), state_).head<6>(),
                       update.gained().topLeftCorner<6, 6>());
  }
  open_motion_ = openDirectionsOfMotion(T_odom_body_0_, update.open().topRows<6>());
  covariance_ = update.covariance();
  cross_ = update.updated(cross_);
  state_ = update.state();
  return matches_.size();
}

std::size_t LioFilter::updateCalibrated(const std::vector<MeasuredPoint>& points,
                                        const FreeFallScan& scan, const Vec3& sensor_body,
                                        const LocalVoxelMap& map, bool rigid) {
  const double ageing = rigid ? 0 : 1;
  const auto place = [&](const CalibratedLioState& s) -> const std::vector<PlacedPoint>& {
    placePoints(points, scan, sensor_body, s, ageing, placed_);
    return placed_;
  };
  auto matches = pointsOnPlanes<9>(matches_, map, ageing, place);
  CalibrationBlock& block = *calibration_;
  block.sensor = SensorMotion(scan, sensor_body);
  ++block.scans;
  const CalibratedLioState prior = block.with(state_);
  const CalibratedLioMatrix S = toLidar(prior), joint = block.joint(covariance_);
  const bool settled =
      block.scans >= kSettling && agreement_.agrees() && agreement_.imuFactor() <= kMostImuFactor;
  CalibratedLioUpdate update({limits_.max_iterations, limits_.max_gate_m});
  if (!runOn(matches, prior, S * joint * S.transpose(), rmsRange(points), settled, update)) {
    return matches_.size();
  }
  const CalibratedLioVector step = boxminus(update.state(), prior);
  if (!rigid) agreement_.compare(step.head<6>(), update.gained().topLeftCorner<6, 6>());
  PoseBefore before{T_odom_body_0_, covariance_0_, {}};
  before.cross << cross_, block.cross_0;
  before = ofLidar(before, block, joint);
  const CalibratedLioMatrix back = toLidar(update.state(), -1);
  const CalibratedLioMatrix updated = back * update.covariance() * back.transpose();
  before.cross = back * update.updated(PoseBefore::Cross(S * before.cross));
  state_ = update.state().x;
  covariance_ = updated.topLeftCorner<lio::kDim, lio::kDim>();
  block.take(update.state().calibration, updated);
  before = ofBody(before, block, step.tail<lio_calibration::kDim>(), updated);
  T_odom_body_0_ = before.pose;
  covariance_0_ = before.covariance;
  cross_ = before.cross.topRows<lio::kDim>();
  open_motion_ = openDirectionsOfMotion(T_odom_body_0_, update.open().topRows<6>());
  return matches_.size();
}

void LioFilter::blur(double position_m, double rotation_rad, double velocity_mps) {
  const auto add = [&](int at, double sigma) {
    covariance_.diagonal().segment<3>(at).array() += sigma * sigma;
  };
  add(lio::kPosition, position_m);
  add(lio::kRotation, rotation_rad);
  add(lio::kVelocity, velocity_mps);
}

Mat6 LioFilter::motionCovariance() const {
  return agreement_.motionFactor() *
         covarianceOfMotion(T_odom_body_0_, state_.T_odom_body, covariance_0_,
                            covariance_.topLeftCorner<6, 6>(), cross_.topRows<6>());
}

}  // namespace paloc

#include "paloc/frontends/icp_filter.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "iterated_update.h"
#include "motion_covariance.h"
#include "settling_points.h"

namespace paloc {
namespace {

constexpr double kLostSigma_m = 100;
// The bend that is likely: its standard deviation, in that of the change from chord to chord, and
// how much of it goes with that change.
constexpr double kBend = 0.5, kFollows = 0.25;
// What a bent chord cannot show of an acceleration that changes twice a second, in a dt^2.
constexpr double kMisfit = 0.04;
// And what the best bent chord leaves of it at the end of its scan, where the acceleration changes
// as a walk's does (Hz): x''' dt^3 / 120, of a cubic beside the parabola that fits it best.
constexpr double kChanges = 1.4, kLeftOfCubic = 2 * std::numbers::pi * kChanges / 120;
constexpr double kSettledSigmas = 0.15;
constexpr std::size_t kSlots = 32;  // rotations that stand for those during a scan

using ChordUpdate = IteratedUpdate<ChordMotion, chord::kDim, 18>;

ChordUpdate::ToMeasured toMeasured(const ChordMotion&) {
  return ChordUpdate::ToMeasured::Identity();
}

double square(double x) { return x * x; }

// The rotation's error is on the left here: an error e there is R^T e on the right.
Mat6 onTheRight(const Pose& pose) {
  Mat6 turn = Mat6::Identity();
  turn.block<3, 3>(3, 3) = pose.rotation.transpose();
  return turn;
}

}  // namespace

void IcpFilter::begin(const ChordMotion& state, const ChordMatrix& covariance) {
  state_ = state;
  covariance_ = covariance;
}

// The velocities change first: then the pose follows with the new ones, so that the scan begins
// where the one before ended. The bend is a new one, likely towards the change of the velocity.
void IcpFilter::predict(double dt_s) {
  dt_s_ = dt_s;
  T_odom_body_0_ = state_.T_odom_body;
  open_motion_.setIdentity();
  covariance_0_ = covariance_.topLeftCorner<6, 6>();
  state_.acceleration_odom = state_.angular_acceleration_body = Vec3::Zero();
  const ChordMatrix F = continuedTransition(state_, dt_s);
  cross_ = F.leftCols<12>() * covariance_.topLeftCorner<12, 6>();
  ChordMatrix P = ChordMatrix::Zero();
  P.topLeftCorner<12, 12>() = covariance_.topLeftCorner<12, 12>();
  const auto disturb = [&](int velocity, int bend, double sigma) {
    const double variance = sigma * sigma;
    P.diagonal().segment<3>(velocity).array() += variance * dt_s * dt_s;
    P.diagonal().segment<3>(bend).setConstant(kBend * kBend * variance);
    P.block<3, 3>(velocity, bend).diagonal().setConstant(kFollows * variance * dt_s);
    P.block<3, 3>(bend, velocity).diagonal().setConstant(kFollows * variance * dt_s);
  };
  disturb(chord::kVelocity, chord::kBend, unevenness_.acceleration_mps2);
  disturb(chord::kRate, chord::kBendOfTurn, unevenness_.angular_acceleration_radps2);
  P = (F * P * F.transpose()).eval();
  covariance_ = 0.5 * (P + P.transpose());
  addMisfit(kMisfit * dt_s * dt_s);
  state_ = continued(state_, dt_s);
}

void IcpFilter::addMisfit(double misfit_s2) {
  covariance_.diagonal().segment<3>(chord::kPosition).array() +=
      square(misfit_s2 * unevenness_.acceleration_mps2);
  covariance_.diagonal().segment<3>(chord::kRotation).array() +=
      square(misfit_s2 * unevenness_.angular_acceleration_radps2);
}

bool IcpFilter::isLost() const {
  return !(displacementSigma<chord::kDim>(covariance_, 0) < kLostSigma_m) ||
         !state_.v_odom.allFinite() || !state_.omega_body.allFinite();
}

void IcpFilter::placePoints(const std::vector<MeasuredPoint>& points, const Vec3& sensor_body,
                            const ChordMotion& x, double ageing) {
  double longest_s = 0;
  for (const MeasuredPoint& p : points) longest_s = std::max(longest_s, p.age_s);
  std::array<Mat3, kSlots + 1> rotations;
  for (std::size_t k = 0; k <= kSlots; ++k) {
    rotations[k] = x.before(ageing * longest_s * static_cast<double>(k) / kSlots).rotation;
  }
  const double per_s = longest_s > 0 ? kSlots / longest_s : 0;
  const Vec3 sensor_odom = x.T_odom_body.rotation * sensor_body;  // near enough for a ray
  placed_.resize(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double tau = points[i].age_s;
    const auto slot = std::min(static_cast<std::size_t>(tau * per_s), kSlots - 1);
    const double ratio = tau * per_s - static_cast<double>(slot);
    const Vec3 from = rotations[slot] * points[i].point_body;
    const Vec3 lever = from + ratio * (rotations[slot + 1] * points[i].point_body - from);
    const double sag = ageing * x.sag(tau);
    const Vec3 moved = ageing * tau * x.v_odom + sag * x.acceleration_odom;
    placed_[i] = {x.T_odom_body.position - moved + lever, lever, lever - sensor_odom, tau, sag};
  }
}

const std::vector<PlacedPoint>& IcpFilter::place(const std::vector<MeasuredPoint>& points,
                                                 const Vec3& sensor_body, bool rigid) {
  placePoints(points, sensor_body, state_, rigid ? 0 : 1);
  return placed_;
}

std::size_t IcpFilter::update(const std::vector<MeasuredPoint>& points, const Vec3& sensor_body,
                              const LocalVoxelMap& map, bool rigid) {
  const double ageing = rigid ? 0 : 1;
  before_update_ = {state_, covariance_, cross_};
  ChordUpdate update({limits_.max_iterations, limits_.max_gate_m, kSettledSigmas});
  const auto place = [&](const ChordMotion& x) -> const std::vector<PlacedPoint>& {
    placePoints(points, sensor_body, x, ageing);
    return placed_;
  };
  auto matches = settlingPoints<18>(matches_, map, ageing, place);
  if (!update.run(state_, covariance_, rmsRange(points), matches, toMeasured)) {
    return matches_.size();
  }
  state_ = update.state();
  // The best guess, but no more sure than the prediction was.
  if (!update.converged()) return 0;
  open_motion_ = openDirectionsOfMotion(
      T_odom_body_0_, onTheRight(state_.T_odom_body) * update.open().topRows<6>());
  covariance_ = update.covariance();
  addMisfit(kLeftOfCubic * dt_s_ * dt_s_ * dt_s_);
  cross_ = update.updated(cross_);
  return matches_.size();
}

void IcpFilter::takeBack() {
  state_ = before_update_.state;
  covariance_ = before_update_.covariance;
  cross_ = before_update_.cross;
  open_motion_.setIdentity();
}

Mat6 IcpFilter::motionCovariance() const {
  const Mat6 turn_0 = onTheRight(T_odom_body_0_), turn = onTheRight(state_.T_odom_body);
  return covarianceOfMotion(T_odom_body_0_, state_.T_odom_body,
                            turn_0 * covariance_0_ * turn_0.transpose(),
                            turn * covariance_.topLeftCorner<6, 6>() * turn.transpose(),
                            turn * cross_.topRows<6>() * turn_0.transpose());
}

}  // namespace paloc

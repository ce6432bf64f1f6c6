#include "paloc/frontends/inertial_smoother.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <cmath>
#include <utility>

#include "lio_update.h"
#include "motion_covariance.h"
#include "paloc/frontends/consider_update.h"

namespace paloc {
namespace {

// The first pose is that of the odom frame, and known; so far as the numbers need it, it is not.
constexpr double kFirstPosition = 1e-4, kFirstRotation = 1e-5;  // m, rad
// Of the length of gravity's direction, of one: what is told of it at the first node stays linear
// in that direction, in which the length changes as the direction turns.
constexpr double kGravityLength = 1e-3, kFirstGravityLength = 0.1;
constexpr double kGravityWalk = 1e-6;  // 1/sqrt(Hz)
// Of an edge, so that it can be inverted: an IMU that is interpolated over a gap has fewer samples
// than there are unknowns.
constexpr double kEdgePosition = 1e-6, kEdgeRotation = 1e-7, kEdgeVelocity = 1e-5;  // m rad m/s
constexpr double kLostSigma_m = 100;

SmootherSettings settingsOf(double lag_s) {
  SmootherSettings settings;
  settings.lag_s = lag_s;
  settings.covariance_of_leaving = false;
  return settings;
}

State toNode(const LioState& x) {
  return {x.T_odom_body, x.v_odom, x.bias_acc, x.bias_gyro, x.gravity_odom.normalized()};
}

LioState toLio(const State& x, double gravity_mps2) {
  return {x.T_map_body, x.v_map, x.bias_acc, x.bias_gyro,
          gravity_mps2 * x.gravity_map.normalized()};
}

// Up follows from the mean force f = b_a + R^T (a - g) of the first scan, so the error of gravity's
// direction is that of the bias, R b_a, and the body's acceleration a, across it, over its
// strength.
StateMatrix firstCovariance(const State& x, const InertialStart& start, double gravity_mps2) {
  using namespace tangent;
  StateVector sigma = StateVector::Zero();
  sigma.segment<3>(kPosition).setConstant(kFirstPosition);
  sigma.segment<3>(kRotation).setConstant(kFirstRotation);
  sigma.segment<3>(kVelocity).setConstant(start.sigma_velocity_mps);
  sigma.segment<3>(kBiasAcc).setConstant(start.sigma_bias_acc_mps2);
  sigma.segment<3>(kBiasGyro).setConstant(start.sigma_bias_gyro_radps);
  StateMatrix covariance = sigma.cwiseAbs2().asDiagonal();
  const Vec3& g = x.gravity_map;
  const Mat3 across = Mat3::Identity() - g * g.transpose();
  const Mat3 by_bias = across * x.T_map_body.rotation / gravity_mps2;
  const double bias_variance = start.sigma_bias_acc_mps2 * start.sigma_bias_acc_mps2;
  const double tilt = start.sigma_acceleration_mps2 / gravity_mps2;
  covariance.block<3, 3>(kGravity, kGravity) =
      bias_variance * by_bias * by_bias.transpose() + tilt * tilt * across +
      kFirstGravityLength * kFirstGravityLength * g * g.transpose();
  covariance.block<3, 3>(kGravity, kBiasAcc) = bias_variance * by_bias;
  covariance.block<3, 3>(kBiasAcc, kGravity) = bias_variance * by_bias.transpose();
  return covariance;
}

// Holds the length of gravity; its direction is left to the IMU.
GravityFactor lengthOfGravity(double gravity_mps2) {
  constexpr double kAnyDirection = 1e6;  // rad
  return {gravity_mps2 * Vec3::UnitZ(), kAnyDirection, kGravityLength};
}

Preintegration withFloor(Preintegration imu, double factor) {
  imu.covariance *= factor;
  const auto add = [&](int at, double sigma) {
    imu.covariance.diagonal().segment<3>(at).array() += sigma * sigma;
  };
  add(0, kEdgePosition);
  add(3, kEdgeRotation);
  add(6, kEdgeVelocity);
  return imu;
}

// Errors of variances `blur` make information W into (W^-1 + B)^-1, also where W is singular.
Mat9 blurred(const Mat9& information, const Vec9& blur) {
  const Mat9 left = Mat9::Identity() + information * blur.asDiagonal();
  const Mat9 result = left.partialPivLu().solve(information);
  return 0.5 * (result + result.transpose());
}

using ToLio = Eigen::Matrix<double, lio::kDim, tangent::kDim>;

// Derivative of the error of a LioState by that of a node: the length of gravity is left out.
ToLio errorToLio(const State& x) {
  static_assert(int{lio::kGravity} == int{tangent::kGravity});
  ToLio derivative = ToLio::Identity();
  const Vec3 g = x.gravity_map.normalized();
  derivative.block<2, 3>(lio::kGravity, tangent::kGravity) =
      tangentBasis(g).transpose() * so3::hat(g);
  return derivative;
}

StateVector widened(const Vec9& scan) {
  StateVector vector = StateVector::Zero();
  vector.head<9>() = scan;
  return vector;
}

using NodeUpdate = ConsiderUpdate<tangent::kDim>;

NodeUpdate::Directions widened(const NullDirections<9>& considered) {
  NodeUpdate::Directions directions =
      NodeUpdate::Directions::Zero(tangent::kDim, considered.cols());
  directions.topRows<9>() = considered;
  return directions;
}

LioMatrix covarianceOfLio(const State& x, const StateMatrix& covariance) {
  const ToLio to_lio = errorToLio(x);
  const LioMatrix P = to_lio * covariance * to_lio.transpose();
  return 0.5 * (P + P.transpose());
}

}  // namespace

InertialSmoother::InertialSmoother(double lag_s, double gravity_mps2)
    : gravity_mps2_(gravity_mps2), settings_(settingsOf(lag_s)), smoother_(settings_) {}

void InertialSmoother::begin(TimeNs t_ns, const LioState& state, const InertialStart& start) {
  const State first = toNode(state);
  beginWindow(t_ns, first, firstCovariance(first, start, gravity_mps2_));
}

void InertialSmoother::beginWindow(TimeNs t_ns, const State& state, const StateMatrix& covariance) {
  ChainNode node;
  node.t_ns = t_ns_ = t_ns;
  node.state = state;
  node.node_factors.push_back(
      PriorFactor(state, covariance.ldlt().solve(StateMatrix::Identity()), StateVector::Zero()));
  smoother_ = FixedLagSmoother(settings_);
  smoother_.add(std::move(node));
  open_ = false;
  takeNewest();
}

void InertialSmoother::takeNewest() {
  const NodeEstimate newest = smoother_.newest();
  node_ = newest.state;
  state_ = toLio(newest.state, gravity_mps2_);
  covariance_ = newest.covariance;
}

std::optional<LioState> InertialSmoother::smoothed(TimeNs t_ns) const {
  for (const NodeEstimate& node : smoother_.window(false)) {
    if (node.t_ns == t_ns) return toLio(node.state, gravity_mps2_);
  }
  return std::nullopt;
}

// With the edge's factors linearized, their normal equations are those of x_j = F x_i + noise.
void InertialSmoother::predict(const Preintegration& imu, const ImuNoise& noise) {
  const ImuFactor factor(withFloor(imu, agreement_.imuFactor()), gravity_mps2_);
  ChainNode from;
  from.state = node_;
  next_ = {};
  next_.state = factor.predict(node_);
  next_.edge_factors = {factor, BiasWalkFactor(noise, imu.dt_s),
                        ConstantGravityFactor(kGravityWalk, imu.dt_s)};
  const ChainBlock edge = linearizeEdge(from, next_);
  const StateMatrix process = edge.hessian_jj.ldlt().solve(StateMatrix::Identity());
  const StateMatrix F = -process * edge.hessian_ji;
  cross_ = F * covariance_;
  const StateMatrix predicted = cross_ * F.transpose() + process;
  covariance_predicted_ = 0.5 * (predicted + predicted.transpose());
  holdLengthOfGravity();
  predicted_ = toLio(next_.state, gravity_mps2_);
}

// A Kalman update of the prediction with what lengthOfGravity() says, so that it is known to the
// registration too.
void InertialSmoother::holdLengthOfGravity() {
  const Vec3& g = next_.state.gravity_map;
  StateVector along = StateVector::Zero();
  along.segment<3>(tangent::kGravity) = g.normalized();
  StateMatrix& P = covariance_predicted_;
  const double variance = along.dot(P * along) + kGravityLength * kGravityLength;
  const StateVector gain = P * along / variance;
  next_.state = boxplus(next_.state, gain * (1 - g.norm()));
  cross_ -= (gain * (along.transpose() * cross_)).eval();
  const StateMatrix updated = P - variance * gain * gain.transpose();
  P = 0.5 * (updated + updated.transpose());
}

LioMatrix InertialSmoother::predictedCovariance() const {
  return covarianceOfLio(next_.state, covariance_predicted_);
}

LioMatrix InertialSmoother::covariance() const { return covarianceOfLio(node_, covariance_); }

// Along what a scan leaves open the node is considered, not estimated: an open direction comes out
// a little otherwise at each scan, and with a position of large variance along it, what two scans
// know across two such directions would tie it down, and the smallest residual across it move it
// far.
void InertialSmoother::add(TimeNs t_ns, const FeatureMeasurement& scan, const Vec9& blur,
                           bool compare) {
  const Mat9 known = blurred(scan.information, blur);
  // The gradient shrinks as the information does: what the scan asks for stays.
  const Vec9 asked = (Mat9::Identity() + scan.information * blur.asDiagonal())
                         .partialPivLu()
                         .solve(-scan.gradient);
  StateMatrix information = StateMatrix::Zero();
  information.topLeftCorner<9, 9>() = known;
  const StateVector off = boxminus(toNode(scan.found), next_.state);
  NodeUpdate update;
  update.begin(covariance_predicted_, widened(scan.open));
  update.measure(information);
  const StateVector step = update.step(StateVector::Zero(), -(widened(asked) + information * off));
  // As the prediction took it: in a new window it is inverted twice, and the motion's covariance is
  // a difference of large numbers along an open direction.
  const Pose before = state_.T_odom_body;
  const Mat6 covariance_before = covariance_.topLeftCorner<6, 6>();
  if (open_) beginWindow(t_ns_, node_, covariance_);
  next_.t_ns = t_ns_ = t_ns;
  next_.node_factors.push_back(PriorFactor(toNode(scan.found), information, widened(asked)));
  next_.node_factors.push_back(lengthOfGravity(gravity_mps2_));
  next_.state = boxplus(next_.state, step);
  const State by_update = next_.state;
  smoother_.add(std::move(next_));
  takeNewest();
  const StateMatrix cross = update.updated(cross_), updated = update.covariance();
  open_ = scan.open.cols() > 0;
  if (open_) {
    node_ = by_update;
    state_ = toLio(node_, gravity_mps2_);
    covariance_ = updated;
  }
  if (compare) {
    // Not the smoother's own: along open directions these are differences of large numbers.
    agreement_.compare(step.head<6>(), update.gained().topLeftCorner<6, 6>());
  }
  open_motion_ =
      compare ? openDirectionsOfMotion(before, scan.open.topRows<6>()) : Mat6(Mat6::Identity());
  motion_covariance_ =
      covarianceOfMotion(before, state_.T_odom_body, covariance_before,
                         updated.topLeftCorner<6, 6>(), cross.topLeftCorner<6, 6>());
}

bool InertialSmoother::isLost() const {
  const double variance = covariance_.diagonal().head<3>().sum();
  return !(variance < kLostSigma_m * kLostSigma_m) || !state_.v_odom.allFinite();
}

Mat6 InertialSmoother::motionCovariance() const {
  return agreement_.motionFactor() * motion_covariance_;
}

}  // namespace paloc

#include "paloc/frontends/lio_filter.h"

#include <Eigen/LU>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <optional>

namespace paloc {
namespace {

constexpr double kLeastWidening = 0.01, kNarrowing = 0.3;  // m; a step
constexpr double kLeastGate = 0.1;                         // m
constexpr double kConvergedM = 3e-4, kConvergedRad = 1e-4;
constexpr std::size_t kMinRows = 20;
constexpr double kLostSigma_m = 100;
// How fast the normalized innovation is averaged, and the IMU's noise follows it.
constexpr double kLearning = 0.05, kMostDisagreement = 100;
constexpr double kFollowing = 0.1, kMostChange = 10, kMostFactor = 300;
constexpr double kLeastGain = 1e-6;  // m, rad
constexpr int kLookAgain = 2;        // iteration that asks anew what is informative

// Normal equations of pose and velocity in the state's own tangent space, rotation on the right.
void spread(const PointToPlaneSums& sums, const Mat3& R, LioMatrix& information,
            LioVector& gradient) {
  Mat9 turn = Mat9::Identity();
  turn.block<3, 3>(lio::kRotation, lio::kRotation) = R;
  information.setZero();
  gradient.setZero();
  information.topLeftCorner<9, 9>() = turn.transpose() * sums.information * turn;
  gradient.head<9>() = turn.transpose() * sums.gradient;
}

// What of an error (17) goes with the error along open directions, as a matrix (17 x 17): P is the
// covariance. `open` is in the tangent space of PointToPlaneSums.
LioMatrix openPart(const LioMatrix& P, const NullDirections& open, const Mat3& R) {
  if (open.cols() == 0) return LioMatrix::Zero();
  using Columns = Eigen::Matrix<double, lio::kDim, Eigen::Dynamic, 0, lio::kDim, 9>;
  Columns E = Columns::Zero(lio::kDim, open.cols());
  E.topRows<9>() = open;
  E.middleRows<3>(lio::kRotation) = R.transpose() * open.middleRows<3>(lio::kRotation);
  const Columns PE = P * E;
  const Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> along(E.transpose() * PE);
  return PE * along.pseudoInverse() * E.transpose();
}

// How far a point at a range of `lever_m` may be from where a state puts it (m): one sigma.
double displacementSigma(const LioMatrix& covariance, double lever_m) {
  const auto variance = [&](int at) { return covariance.diagonal().segment<3>(at).sum(); };
  return std::sqrt(variance(lio::kPosition) + lever_m * lever_m * variance(lio::kRotation));
}

}  // namespace

void LioFilter::begin(const LioState& state, const LioMatrix& covariance) {
  state_ = state;
  covariance_ = covariance;
}

void LioFilter::predict(const Preintegration& imu, const ImuNoise& noise) {
  T_odom_body_0_ = state_.T_odom_body;
  covariance_0_ = covariance_.topLeftCorner<6, 6>();
  const LioMatrix F = lioTransition(state_, imu);
  cross_ = F * covariance_.leftCols<6>();
  const LioMatrix predicted =
      F * covariance_ * F.transpose() + imu_factor_ * lioProcessNoise(state_, imu, noise);
  covariance_ = 0.5 * (predicted + predicted.transpose());
  state_ = predictLio(state_, imu);
}

double LioFilter::lever(const std::vector<MeasuredPoint>& points) const {
  double sum = 0;
  for (const MeasuredPoint& p : points) sum += p.point_body.squaredNorm();
  return std::sqrt(sum / static_cast<double>(std::max<std::size_t>(points.size(), 1)));
}

void LioFilter::placePoints(const std::vector<MeasuredPoint>& points, const FreeFallScan& scan,
                            const Vec3& sensor_body, const LioState& x, double ageing) {
  const Mat3& R = x.T_odom_body.rotation;
  const Vec3 sensor_odom = R * sensor_body;  // near enough for a ray
  placed_.resize(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double tau = points[i].age_s;
    const Vec3 lever = R * scan.place(points[i].point_body, tau);
    const Vec3 moved = ageing * tau * (0.5 * tau * x.gravity_odom - x.v_odom);
    placed_[i] = {x.T_odom_body.position + moved + lever, lever, lever - sensor_odom, tau};
  }
}

const std::vector<PlacedPoint>& LioFilter::place(const std::vector<MeasuredPoint>& points,
                                                 const FreeFallScan& scan, const Vec3& sensor_body,
                                                 bool rigid) {
  placePoints(points, scan, sensor_body, state_, rigid ? 0 : 1);
  return placed_;
}

bool LioFilter::isLost() const {
  const double sigma = displacementSigma(covariance_, 0);
  return !(sigma < kLostSigma_m) || !state_.v_odom.allFinite();
}

std::size_t LioFilter::update(const std::vector<MeasuredPoint>& points, const FreeFallScan& scan,
                              const Vec3& sensor_body, const LocalVoxelMap& map, bool rigid) {
  const double ageing = rigid ? 0 : 1;
  const double lever_m = lever(points);
  const double deviation = displacementSigma(covariance_, lever_m);
  const double gate = std::min(limits_.max_gate_m, 3 * deviation + kLeastGate);
  double widening = std::min(deviation, gate);
  bool converged = false;
  LioState x = state_;
  LioMatrix information = LioMatrix::Zero();
  LioVector gradient = LioVector::Zero();
  // A scan updates the state as if that along open directions were given, and leaves the rest as it
  // was (after S. F. Schmidt's consider states). Left in the equations, an open position of large
  // variance would follow from the smallest error of the direction that is believed to be open.
  std::optional<InformativePart> informative;
  LioMatrix open = LioMatrix::Zero(), touched = covariance_;
  for (int i = 0; i < limits_.max_iterations && !converged; ++i) {
    placePoints(points, scan, sensor_body, x, ageing);
    matches_.associate(placed_, map, gate);
    if (matches_.size() < kMinRows) return matches_.size();
    matches_.weigh(widening);
    PointToPlaneSums sums = matches_.sums(ageing);
    if (i == 0 || i == kLookAgain) {
      informative.emplace(sums.information, matches_.normalNoise(ageing));
      open = openPart(covariance_, informative->open(), x.T_odom_body.rotation);
      touched = covariance_ - open * covariance_;
      touched = (0.5 * (touched + touched.transpose())).eval();
      widening = std::min(widening, displacementSigma(touched, lever_m));
    }
    informative->apply(sums);
    spread(sums, x.T_odom_body.rotation, information, gradient);
    // (P^-1 + H) d = P^-1 (prior - x) - gradient, times P: no inverse of a covariance is needed.
    const LioMatrix system = LioMatrix::Identity() + touched * information;
    const LioVector step = system.partialPivLu().solve(boxminus(state_, x) - touched * gradient);
    if (!step.allFinite()) return matches_.size();
    x = boxplus(x, step);
    converged = widening == 0 && step.segment<3>(lio::kPosition).norm() < kConvergedM &&
                step.segment<3>(lio::kRotation).norm() < kConvergedRad;
    widening = widening < kLeastWidening ? 0 : kNarrowing * widening;
  }
  const Eigen::PartialPivLU<LioMatrix> system(LioMatrix::Identity() + touched * information);
  const LioMatrix updated = system.solve(touched) + (covariance_ - touched);
  if (!rigid) compare(boxminus(x, state_).head<6>(), covariance_ - updated);
  covariance_ = 0.5 * (updated + updated.transpose());
  cross_ = (system.solve(cross_ - open * cross_) + open * cross_).eval();
  state_ = x;
  return matches_.size();
}

// The step of an update has the covariance that the update takes away: its squared norm in that, a
// degree of freedom, is the normalized innovation squared, and 1 if IMU and scans are as good as
// they are said to be (Y. Bar-Shalom et al., "Estimation with Applications to Tracking and
// Navigation", 2001, section 5.4.2).
void LioFilter::compare(const Vec6& step, const LioMatrix& gained) {
  Eigen::Matrix<double, 6, 6> covariance = gained.topLeftCorner<6, 6>();
  covariance.diagonal().array() += kLeastGain * kLeastGain;
  const Eigen::Matrix<double, 6, 1> d = step;
  const double squared = d.dot(covariance.ldlt().solve(d)) / 6;
  if (!std::isfinite(squared) || squared < 0) return;
  disagreement_ += kLearning * (std::min(squared, kMostDisagreement) - disagreement_);
  const double change = std::clamp(squared, 1 / kMostChange, kMostChange);
  imu_factor_ = std::clamp(imu_factor_ * std::pow(change, kFollowing), 1.0, kMostFactor);
}

void LioFilter::blur(double position_m, double rotation_rad, double velocity_mps) {
  const auto add = [&](int at, double sigma) {
    covariance_.diagonal().segment<3>(at).array() += sigma * sigma;
  };
  add(lio::kPosition, position_m);
  add(lio::kRotation, rotation_rad);
  add(lio::kVelocity, velocity_mps);
}

// With e the error of the pose now and e_0 that of the one before, in the tangent spaces of the
// poses: the error of the motion's position is R_0^T (e_p - e_0p) + hat(t) e_0r, t the motion's
// position, and that of its rotation e_r - R^T e_0r, R the motion's rotation.
Mat6 LioFilter::motionCovariance() const {
  const Pose motion = T_odom_body_0_.inverse() * state_.T_odom_body;
  const Mat3 R_0 = T_odom_body_0_.rotation;
  Mat6 now = Mat6::Zero(), before = Mat6::Zero();
  now.block<3, 3>(0, 0) = R_0.transpose();
  now.block<3, 3>(3, 3) = Mat3::Identity();
  before.block<3, 3>(0, 0) = -R_0.transpose();
  before.block<3, 3>(0, 3) = so3::hat(motion.position);
  before.block<3, 3>(3, 3) = -motion.rotation.transpose();
  const Mat6 cross = now * cross_.topRows<6>() * before.transpose();
  const Mat6 covariance = now * covariance_.topLeftCorner<6, 6>() * now.transpose() +
                          before * covariance_0_ * before.transpose() + cross + cross.transpose();
  const double scale = std::max(1.0, disagreement_ - 1);
  return 0.5 * scale * (covariance + covariance.transpose());
}

}  // namespace paloc

#include "paloc/core/dense_trajectory.h"

#include <algorithm>
#include <cmath>

#include "paloc/core/imu_factor.h"
#include "paloc/core/mrpt_pose.h"

namespace paloc {
namespace {

// Nearer to a node than this, the node's own covariance is as good, and the IMU's noise over the
// time to it too small to be computed with.
constexpr double kAtNode_s = 1e-3;
// What the platform may do between two nodes that no IMU data joins.
constexpr double kAcceleration_mps2 = 3, kAngularAcceleration_radps2 = 10;

State stateOf(const TrajectoryPoint& point) {
  State state;
  state.T_map_body = fromMrpt(point.T_map_body);
  state.v_map = point.v_map;
  state.bias_acc = point.bias_acc;
  state.bias_gyro = point.bias_gyro;
  state.gravity_map = point.gravity_map;
  return state;
}

// Without IMU data: even motion from the node.
State carriedOn(const State& from, double dt_s) {
  State state = from;
  state.T_map_body.position += from.v_map * dt_s;
  return state;
}

// The share of the error at the end of an interval that is taken off at ratio s of it. Position
// follows Hermite's cubic that leaves with no correction and arrives with the whole of it, velocity
// as its derivative, so that both meet the node after; rotation goes evenly.
void leadOnto(const State& end_predicted, const State& end, double s, double dt_s, State& x) {
  const Vec6 error = boxminus(end.T_map_body, end_predicted.T_map_body);
  const Vec3 error_v = end.v_map - end_predicted.v_map;
  const double s2 = s * s, s3 = s2 * s;
  x.T_map_body.position += (3 * s2 - 2 * s3) * error.head<3>() + (s3 - s2) * dt_s * error_v;
  x.v_map += (6 * s - 6 * s2) / dt_s * error.head<3>() + (3 * s2 - 2 * s) * error_v;
  x.T_map_body.rotation = so3::normalized(x.T_map_body.rotation * so3::exp(s * error.tail<3>()));
  x.bias_acc += s * (end.bias_acc - x.bias_acc);
  x.bias_gyro += s * (end.bias_gyro - x.bias_gyro);
  x.gravity_map = (x.gravity_map + s * (end.gravity_map - x.gravity_map)).normalized();
}

// Every variance of a point, in the order of State's tangent.
void addVariances(const StateVector& variances, TrajectoryPoint& point) {
  const auto raise = [&](Vec3& sigma, int offset) {
    sigma = (sigma.cwiseAbs2() + variances.segment<3>(offset)).cwiseMax(0.0).cwiseSqrt();
  };
  raise(point.v_sigma, tangent::kVelocity);
  raise(point.bias_acc_sigma, tangent::kBiasAcc);
  raise(point.bias_gyro_sigma, tangent::kBiasGyro);
  raise(point.gravity_sigma, tangent::kGravity);
}

// The covariances of both nodes in their shares.
void interpolateCovariance(const TrajectoryPoint& a, const TrajectoryPoint& b, double s,
                           TrajectoryPoint& point) {
  const auto mixed = [s](const Vec3& of_a, const Vec3& of_b) -> Vec3 {
    return ((1 - s) * of_a.cwiseAbs2() + s * of_b.cwiseAbs2()).cwiseSqrt();
  };
  point.covariance = (1 - s) * a.covariance + s * b.covariance;
  point.v_sigma = mixed(a.v_sigma, b.v_sigma);
  point.bias_acc_sigma = mixed(a.bias_acc_sigma, b.bias_acc_sigma);
  point.bias_gyro_sigma = mixed(a.bias_gyro_sigma, b.bias_gyro_sigma);
  point.gravity_sigma = mixed(a.gravity_sigma, b.gravity_sigma);
}

// An unknown acceleration that takes the body off its cubic and back onto the node after.
void addWandering(double s, double dt_s, TrajectoryPoint& point) {
  const double way = 0.5 * s * (1 - s) * dt_s * dt_s, time_s = s * (1 - s) * dt_s;
  point.covariance.diagonal().head<3>().array() += std::pow(kAcceleration_mps2 * way, 2);
  point.covariance.diagonal().tail<3>().array() += std::pow(kAngularAcceleration_radps2 * way, 2);
  StateVector variances = StateVector::Zero();
  variances.segment<3>(tangent::kVelocity).setConstant(std::pow(kAcceleration_mps2 * time_s, 2));
  addVariances(variances, point);
}

}  // namespace

DenseTrajectory::DenseTrajectory(const Result& result, ImuBuffer imu,
                                 const EstimatorSettings& settings, double max_gap_s)
    : nodes_(result.trajectory),
      covariances_(result.covariances),
      covariances_with_next_(result.covariances_with_next),
      imu_(std::move(imu)),
      settings_(settings),
      max_gap_s_(max_gap_s) {}

std::optional<TrajectoryPoint> DenseTrajectory::at(TimeNs t_ns) const {
  const auto after =
      std::lower_bound(nodes_.begin(), nodes_.end(), t_ns,
                       [](const TrajectoryPoint& node, TimeNs t) { return node.t_ns < t; });
  if (after == nodes_.end()) return std::nullopt;
  if (after->t_ns == t_ns) return *after;
  if (after == nodes_.begin()) return std::nullopt;
  const TrajectoryPoint& before = *(after - 1);
  const bool bridged = secondsBetween(before.t_ns, after->t_ns) <= max_gap_s_ ||
                       integrated(stateOf(before), before.t_ns, after->t_ns).has_value();
  if (!bridged) return std::nullopt;
  return between(static_cast<std::size_t>(after - nodes_.begin()) - 1, t_ns);
}

std::optional<Preintegration> DenseTrajectory::integrated(const State& from, TimeNs start_ns,
                                                          TimeNs end_ns) const {
  return imu_.integrate(start_ns, end_ns, settings_.max_imu_gap_s, settings_.imu, from.bias_acc,
                        from.bias_gyro);
}

std::vector<EdgeFactor> DenseTrajectory::factorsOf(const Preintegration& imu) const {
  return {ImuFactor(imu, settings_.gravity_mps2), BiasWalkFactor(settings_.imu, imu.dt_s),
          ConstantGravityFactor(settings_.gravity_walk_sqrthz, imu.dt_s)};
}

TrajectoryPoint DenseTrajectory::between(std::size_t before, TimeNs t_ns) const {
  const TrajectoryPoint &a = nodes_[before], &b = nodes_[before + 1];
  const State from = stateOf(a), to = stateOf(b);
  const double dt_s = secondsBetween(a.t_ns, b.t_ns);
  const double s = secondsBetween(a.t_ns, t_ns) / dt_s;
  const auto whole = integrated(from, a.t_ns, b.t_ns);
  const auto part = whole ? integrated(from, a.t_ns, t_ns) : std::nullopt;
  const auto predicted = [&](const std::optional<Preintegration>& imu, double time_s) {
    return imu ? ImuFactor(*imu, settings_.gravity_mps2).predict(from) : carriedOn(from, time_s);
  };
  State x = predicted(part, s * dt_s);
  leadOnto(predicted(part ? whole : std::nullopt, dt_s), to, s, dt_s, x);

  TrajectoryPoint point = s < 0.5 ? a : b;
  point.t_ns = t_ns;
  point.T_map_body = toMrpt(x.T_map_body);
  point.v_map = x.v_map;
  point.bias_acc = x.bias_acc;
  point.bias_gyro = x.bias_gyro;
  point.gravity_map = x.gravity_map;
  interpolateCovariance(a, b, s, point);
  if (part) {
    setCovariance(before, x, point);
  } else {
    addWandering(s, dt_s, point);
  }
  setFlag(a, b, point);
  return point;
}

// Adds to the interpolated covariance what the state between the nodes has beyond it: what the
// nodes' covariances hold besides the smoother's own stays in.
void DenseTrajectory::setCovariance(std::size_t before, const State& x,
                                    TrajectoryPoint& point) const {
  const TrajectoryPoint &a = nodes_[before], &b = nodes_[before + 1];
  const double to_a_s = secondsBetween(a.t_ns, point.t_ns);
  const double to_b_s = secondsBetween(point.t_ns, b.t_ns);
  if (std::min(to_a_s, to_b_s) < kAtNode_s) return;
  const State from = stateOf(a);
  const auto first = integrated(from, a.t_ns, point.t_ns),
             second = integrated(x, point.t_ns, b.t_ns);
  if (!first || !second) return;
  const StateBetween middle =
      conditionOnNeighbours(from, factorsOf(*first), x, factorsOf(*second), stateOf(b));
  StateMatrix beyond = middle.own;
  if (before < covariances_with_next_.size()) {
    const double s = to_a_s / (to_a_s + to_b_s);
    beyond = middle.covariance(covariances_[before], covariances_with_next_[before],
                               covariances_[before + 1]) -
             (1 - s) * covariances_[before] - s * covariances_[before + 1];
  }
  point.covariance += beyond.topLeftCorner<6, 6>();
  addVariances(beyond.diagonal(), point);
}

void DenseTrajectory::setFlag(const TrajectoryPoint& a, const TrajectoryPoint& b,
                              TrajectoryPoint& point) const {
  point.flag = std::max(a.flag, b.flag);
  const double away_s =
      std::min(secondsBetween(a.t_ns, point.t_ns), secondsBetween(point.t_ns, b.t_ns));
  if (away_s > settings_.coasting_after_s) point.flag = std::max(point.flag, PoseFlag::kCoasting);
  const double variance = point.covariance.diagonal().head<3>().maxCoeff();
  if (!(std::sqrt(variance) <= settings_.lost_sigma_position_m)) point.flag = PoseFlag::kLost;
}

std::vector<TimeNs> DenseTrajectory::imuStamps() const {
  if (nodes_.empty()) return {};
  return imu_.stamps(nodes_.front().t_ns, nodes_.back().t_ns);
}

}  // namespace paloc

#include "paloc/core/dense_trajectory.h"

#include <algorithm>

#include "paloc/core/imu_factor.h"
#include "paloc/core/mrpt_pose.h"

namespace paloc {
namespace {

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
}

}  // namespace

DenseTrajectory::DenseTrajectory(std::vector<TrajectoryPoint> nodes, ImuBuffer imu,
                                 double gravity_mps2, double max_imu_gap_s, double max_gap_s)
    : nodes_(std::move(nodes)),
      imu_(std::move(imu)),
      gravity_mps2_(gravity_mps2),
      max_imu_gap_s_(max_imu_gap_s),
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
  return between(before, *after, t_ns);
}

std::optional<State> DenseTrajectory::integrated(const State& from, TimeNs start_ns,
                                                 TimeNs end_ns) const {
  const auto p =
      imu_.integrate(start_ns, end_ns, max_imu_gap_s_, ImuNoise(), from.bias_acc, from.bias_gyro);
  if (!p) return std::nullopt;
  return ImuFactor(*p, gravity_mps2_).predict(from);
}

TrajectoryPoint DenseTrajectory::between(const TrajectoryPoint& a, const TrajectoryPoint& b,
                                         TimeNs t_ns) const {
  const State from = stateOf(a), to = stateOf(b);
  const double dt_s = secondsBetween(a.t_ns, b.t_ns);
  const double s = secondsBetween(a.t_ns, t_ns) / dt_s;
  auto end = integrated(from, a.t_ns, b.t_ns);
  auto now = end ? integrated(from, a.t_ns, t_ns) : std::nullopt;
  if (!now) {
    end = carriedOn(from, dt_s);
    now = carriedOn(from, s * dt_s);
  }
  State x = *now;
  leadOnto(*end, to, s, dt_s, x);

  // Neighbouring nodes are so strongly correlated that their mean is no more certain than they are.
  TrajectoryPoint point = s < 0.5 ? a : b;
  point.t_ns = t_ns;
  point.T_map_body = toMrpt(x.T_map_body);
  point.v_map = x.v_map;
  point.bias_acc = from.bias_acc + s * (to.bias_acc - from.bias_acc);
  point.bias_gyro = from.bias_gyro + s * (to.bias_gyro - from.bias_gyro);
  point.covariance = (1 - s) * a.covariance + s * b.covariance;
  point.v_sigma = (1 - s) * a.v_sigma + s * b.v_sigma;
  point.bias_acc_sigma = (1 - s) * a.bias_acc_sigma + s * b.bias_acc_sigma;
  point.bias_gyro_sigma = (1 - s) * a.bias_gyro_sigma + s * b.bias_gyro_sigma;
  point.flag = std::max(a.flag, b.flag);
  return point;
}

std::vector<TimeNs> DenseTrajectory::imuStamps() const {
  if (nodes_.empty()) return {};
  return imu_.stamps(nodes_.front().t_ns, nodes_.back().t_ns);
}

}  // namespace paloc

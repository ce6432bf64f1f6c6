#include "icp_tracker.h"

#include <utility>

#include "paloc/frontends/weak_direction.h"

namespace paloc {
namespace {

constexpr double kLeastMatched = 0.1;  // of the points: fewer, and the scan is not used
constexpr int kMotionSteps = 32;       // poses that stand for the motion in a scan

}  // namespace

IcpTracker::IcpTracker(const FrontendSettings& settings)
    : settings_(settings),
      filter_(
          {settings.icp.max_iterations, settings.local_map.noise_floor_m,
           settings.local_map.max_gate_m},
          {settings.icp.sigma_acceleration_mps2, settings.icp.sigma_angular_acceleration_radps2}),
      map_(settings.local_map),
      selection_(settings) {}

IcpTracker::Outcome IcpTracker::add(const LidarFrame& frame, const ImuBuffer& /*imu*/,
                                    bool has_times) {
  sensor_body_ = frame.T_body_lidar.position;
  const TimeNs last_end_ns = scan_.end_ns;
  scan_ = {frame.stamp_ns, frame.endNs()};
  {
    StageScope stage(timer_, "thinning");
    selection_.select(frame, has_times, static_cast<std::size_t>(settings_.icp.map_points), nullptr,
                      map_points_);
    points_ = everyNth(map_points_, registrationPoints());
  }
  const double pause_s = secondsBetween(tracked_ns_, frame.stamp_ns);
  if (!begun_ || pause_s > settings_.local_map.max_gap_s || filter_.isLost()) return begin();
  filter_.predict(secondsBetween(last_end_ns, scan_.end_ns));
  if (!first_.points.empty()) startMoving();
  const std::size_t matched = updateWithMorePoints();
  const auto wanted = static_cast<double>(points_.size());
  if (matched == 0 || static_cast<double>(matched) < kLeastMatched * wanted) {
    return Outcome::kCoasted;
  }
  tracked_ns_ = scan_.end_ns;
  StageScope stage(timer_, "map update");
  addToMap(map_points_);
  return Outcome::kTracked;
}

IcpTracker::Outcome IcpTracker::begin() {
  ChordMotion state;
  if (begun_) state.T_odom_body = filter_.state().T_odom_body;
  begun_ = !points_.empty();
  if (!begun_) return Outcome::kRefused;
  ChordVector sigma = ChordVector::Zero();
  sigma.segment<3>(chord::kVelocity).setConstant(settings_.icp.sigma_velocity_mps);
  sigma.segment<3>(chord::kRate).setConstant(settings_.icp.sigma_rate_radps);
  filter_.begin(state, sigma.cwiseAbs2().asDiagonal());
  tracked_ns_ = scan_.end_ns;
  map_.clear();
  addToMap(map_points_, true);
  first_ = {scan_, state, map_points_};
  return Outcome::kBegun;
}

// At the second scan: finds the velocities, and makes the map of the first scan anew with them.
void IcpTracker::startMoving() {
  const IcpFilter predicted = filter_;
  const double dt_s = secondsBetween(first_.scan.end_ns, scan_.end_ns);
  update(true);
  first_.state.v_odom = filter_.state().v_odom;
  first_.state.omega_body = filter_.state().omega_body;
  filter_.restart(first_.state);
  map_.clear();
  addToMap(std::exchange(first_.points, {}));
  filter_ = predicted;
  filter_.restart(continued(first_.state, dt_s));
}

std::size_t IcpTracker::update(bool rigid) {
  StageScope stage(timer_, "registration");
  return filter_.update(points_, sensor_body_, map_, rigid);
}

std::size_t IcpTracker::updateWithMorePoints() {
  const std::size_t matched = update();
  if (matched == 0) return 0;
  const auto weak = weakDirection(filter_.normals());
  if (!weak) return matched;
  {
    StageScope stage(timer_, "registration");
    const auto more = pointsThatTell(*weak, filter_.place(map_points_, sensor_body_),
                                     stepOf(map_points_.size(), registrationPoints()), map_);
    if (more.empty()) return matched;
    for (const std::uint32_t i : more) points_.push_back(map_points_[i]);
    filter_.takeBack();
  }
  return update();
}

void IcpTracker::addToMap(const std::vector<MeasuredPoint>& points, bool rigid) {
  for (const PlacedPoint& p : filter_.place(points, sensor_body_, rigid)) {
    map_.add(p.point_odom, p.ray);
  }
  map_.endScan(filter_.state().T_odom_body.position);
}

ScanMotion IcpTracker::motionDuring(const KeptScan& scan, const ChordMotion& x) {
  ScanMotionInput input;
  input.start_ns = scan.start_ns;
  input.end_ns = scan.end_ns;
  for (int i = 0; i <= kMotionSteps; ++i) {
    const TimeNs t_ns = scan.start_ns + (scan.end_ns - scan.start_ns) * i / kMotionSteps;
    input.odometry.push_back({t_ns, x.before(secondsBetween(t_ns, scan.end_ns))});
  }
  return ScanMotion(input);
}

}  // namespace paloc

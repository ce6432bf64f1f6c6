#include "paloc/core/trajectory_generator.h"

#include <algorithm>
#include <cmath>

#include "paloc/core/lost_nodes.h"
#include "paloc/core/measured_up.h"
#include "paloc/core/mrpt_pose.h"
#include "paloc/core/predict_state.h"
#include "paloc/core/predicted_covariance.h"
#include "paloc/core/scan_correction.h"
#include "paloc/core/scan_skew.h"
#include "paloc/core/start_prior.h"
#include "paloc/core/trajectory_point.h"

namespace paloc {
namespace {

constexpr double kMinGuessSigmaPosition = 0.03;  // m: registration may always correct this much
constexpr double kMinGuessSigmaRotation = 0.01;  // rad
constexpr double kBriefGap_s = 1.0;              // in which a platform does not stop or start
constexpr double kFirstFrameInterval_s = 0.1;    // stands for the time since a frame that never was

}  // namespace

TrajectoryGenerator::TrajectoryGenerator(const EstimatorSettings& settings,
                                         std::shared_ptr<MapMatcher> matcher)
    : settings_(settings),
      matcher_(std::move(matcher)),
      stillness_(settings.stillness),
      correlation_(settings.map_correlation_distance_m),
      plausibility_(settings),
      relocation_(settings),
      smoother_(settings.smoother),
      scans_(settings.rematch_memory_mb),
      start_(settings) {}

TrajectoryGenerator::~TrajectoryGenerator() = default;

void TrajectoryGenerator::setInitialPose(const mrpt::poses::CPose3D& T_map_body) {
  start_.setGuess(StartGuess::near(T_map_body));
}

void TrajectoryGenerator::add(const FrontendEvent& event) {
  if (const auto* sample = std::get_if<ImuSample>(&event)) {
    addImu(*sample);
  } else {
    addFrame(std::get<OdometryFrame>(event));
  }
}

void TrajectoryGenerator::addImu(const ImuSample& sample) {
  if (imu_.add(sample)) {
    stillness_.addImu(sample);
  } else {
    unused_.add("ImuSample", "estimator", "not newer than the last, or not finite");
  }
}

void TrajectoryGenerator::addFrame(const OdometryFrame& frame) {
  if (!history_.empty() && frame.t_ns <= history_.back().node.t_ns) {
    unused_.add("OdometryFrame", "estimator", "not newer than the last");
    return;
  }
  const Pose T_odom_body = fromMrpt(frame.T_odom_body);
  if (!T_odom_body.position.allFinite() || !T_odom_body.rotation.allFinite()) {
    unused_.add("OdometryFrame", "estimator", "its pose is not finite");
    motion_skipped_ += independentMotion(frame);
    odometry_broken_ = odometry_broken_ || !frame.continues;
    return;
  }
  stillness_.addOdometry(frame.t_ns, T_odom_body, frame.continues);
  start_.follow(T_odom_body, frame.continues && !odometry_broken_);
  if (history_.empty()) {
    tryStart(frame);
    rememberOdometry(T_odom_body);
  } else {
    advance(sinceLastNode(frame));
  }
}

// The motion that an odometry factor covers begins at the last node, and frames that were passed
// over since belong to it.
OdometryFrame TrajectoryGenerator::sinceLastNode(const OdometryFrame& frame) const {
  OdometryFrame whole = frame;
  whole.continues = frame.continues && !odometry_broken_;
  whole.motion_covariance = independentMotion(frame) + motion_skipped_;
  whole.open_motion.setZero();
  return whole;
}

void TrajectoryGenerator::rememberOdometry(const Pose& T_odom_body) {
  T_odom_body_last_ = T_odom_body;
  motion_skipped_.setZero();
  odometry_broken_ = false;
}

void TrajectoryGenerator::tryStart(const OdometryFrame& frame) {
  FrameDiagnostics row;
  row.t_ns = row.scan_start_ns = frame.t_ns;
  row.match.refusal = frame.scan ? MatchRefusal::kNotTried : MatchRefusal::kNoScan;
  if (frame.scan) {
    row.scan_start_ns = frame.scan->start_ns;
    if (const auto guess = start_.guessAt(frame.t_ns, measuredUp(imu_, frame.t_ns, settings_))) {
      StageScope stage(timer_, "locate");
      row.match = matcher_->locate(*startScan(frame.scan), *guess);
      start_.tried(frame.t_ns, *guess, row.match);
      if (guess->T_map_body) {
        const Vec6 step = boxminus(fromMrpt(row.match.T_map_body), fromMrpt(*guess->T_map_body));
        row.guess_step_position = step.head<3>();
        row.guess_step_rotation = step.tail<3>().norm();
      }
    }
  }
  diagnostics_.push_back(row);
  if (row.match.accepted()) start(frame, row.match);
}

// Of the motion during the first scan nothing is known.
std::shared_ptr<const Scan> TrajectoryGenerator::startScan(
    const std::shared_ptr<const Scan>& scan) const {
  const double scan_s = secondsBetween(scan->start_ns, scan->end_ns);
  if (scan->skew == ScanSkew::kNone || !(scan_s > 0)) return scan;
  return std::make_shared<const Scan>(
      withSkewTold(*scan, Pose{}, unmeasuredMotion(scan_s, settings_), scan_s));
}

void TrajectoryGenerator::start(const OdometryFrame& frame, const MapMatch& match) {
  ChainNode node;
  node.t_ns = frame.t_ns;
  node.state.T_map_body = fromMrpt(match.T_map_body);
  node.node_factors.push_back(startPrior(node.state, settings_));
  addMapFactor(match, kFirstFrameInterval_s, node);
  if (smoother_.add(node).status == UpdateSummary::Status::kRefused) return;
  const Pose guess = node.state.T_map_body;
  history_.push_back({std::move(node), diagnostics_.size() - 1, scans_.associate(match, guess)});
  diagnostics_.back().match.thinned.reset();
}

// A start that the scans after it do not bear out is forgotten, with all that hangs on it, and
// sought anew.
void TrajectoryGenerator::dropStart() {
  for (std::size_t k = history_.front().diagnostics_index; k < diagnostics_.size(); ++k) {
    diagnostics_[k].match.refusal = MatchRefusal::kNotConfirmed;
  }
  history_.clear();
  online_.clear();
  smoother_ = FixedLagSmoother(settings_.smoother);
  window_first_ = 0;
  correlation_ = ScanCorrelation(settings_.map_correlation_distance_m);
  plausibility_ = MatchPlausibility(settings_);
  few_points_.forget();
  scans_ = KeptScans(settings_.rematch_memory_mb);
  refusals_in_a_row_ = 0;
  start_.drop();
}

void TrajectoryGenerator::advance(const OdometryFrame& frame) {
  const NodeEstimate last = smoother_.newest();
  const double dt_s = secondsBetween(last.t_ns, frame.t_ns);
  const Pose motion = T_odom_body_last_.inverse() * fromMrpt(frame.T_odom_body);
  std::optional<ImuFactor> imu;
  {
    StageScope stage(timer_, "preintegrate");
    if (const auto p = imu_.integrate(last.t_ns, frame.t_ns, settings_.max_imu_gap_s, settings_.imu,
                                      last.state.bias_acc, last.state.bias_gyro)) {
      imu.emplace(*p, settings_.gravity_mps2);
    }
    imu_.forgetBefore(last.t_ns);  // what comes after is needed again if this frame is refused
  }
  ChainNode node;
  node.t_ns = frame.t_ns;
  node.state = imu ? imu->predict(last.state) : predictWithoutImu(last.state, frame, motion, dt_s);

  FrameDiagnostics row;
  row.t_ns = frame.t_ns;
  row.scan_start_ns = frame.scan ? frame.scan->start_ns : frame.t_ns;
  row.match = askMap(withBestScan(frame, last, node.state, imu.has_value()), last, node.state,
                     imu.has_value());
  if (row.match.accepted()) {
    few_points_.check(last.state.T_map_body, node.state.T_map_body, row.match);
  } else {
    few_points_.forget();
  }
  const Vec6 step = boxminus(fromMrpt(row.match.T_map_body), node.state.T_map_body);
  row.guess_step_position = step.head<3>();
  row.guess_step_rotation = step.tail<3>().norm();
  addEdgeFactors(frame, last.state.T_map_body, imu, dt_s, node, row);
  std::optional<Pose> T_found_expected;  // of a lost body that is found
  if (row.match.accepted() && row.match.searched) {
    T_found_expected = fromMrpt(row.match.T_map_body) * node.state.T_map_body.inverse();
    displace(*T_found_expected, node.state);
    correlation_ = ScanCorrelation(settings_.map_correlation_distance_m);
  }
  if (row.match.accepted()) addMapFactor(row.match, dt_s, node);
  row.at_rest = stillness_.update(frame.t_ns, last.state.bias_gyro);
  if (row.at_rest) addStationaryFactors(last.t_ns, diagnostics_.back().at_rest, node);
  const bool believed = start_.confirm(row.match);
  if (append(std::move(node), row, T_found_expected)) {
    rememberOdometry(fromMrpt(frame.T_odom_body));
  } else {
    ++refusals_in_a_row_;
    motion_skipped_ = frame.motion_covariance;
    odometry_broken_ = !frame.continues;
  }
  if (!believed) dropStart();
}

// The frame with its scan as free of the motion as what is known of that makes it.
OdometryFrame TrajectoryGenerator::withBestScan(const OdometryFrame& frame,
                                                const NodeEstimate& last, const State& predicted,
                                                bool by_imu) const {
  if (!frame.scan) return frame;
  if (frame.scan->skew == ScanSkew::kNone) {
    return by_imu ? withScanDeskewedAnew(frame, last, predicted) : frame;
  }
  const double dt_s = secondsBetween(last.t_ns, frame.t_ns);
  Mat6 covariance = frame.continues ? frame.motion_covariance : unmeasuredMotion(dt_s, settings_);
  if (by_imu && frame.scan->skew == ScanSkew::kWhole) {
    // How the body turned the IMU tells; how fast it went at the beginning, the last node.
    const Mat3& R_map_last = last.state.T_map_body.rotation;
    const Mat3 velocity = last.covariance.block<3, 3>(tangent::kVelocity, tangent::kVelocity);
    covariance.setZero();
    covariance.topLeftCorner<3, 3>() =
        R_map_last.transpose() * (dt_s * dt_s * velocity) * R_map_last;
  }
  const Pose motion = last.state.T_map_body.inverse() * predicted.T_map_body;
  OdometryFrame best = frame;
  best.scan = std::make_shared<const Scan>(withSkewTold(*frame.scan, motion, covariance, dt_s));
  return best;
}

// What the map says of the scan: from where it is expected, or of a lost body from anywhere; such
// an answer is told as `searched`.
MapMatch TrajectoryGenerator::askMap(const OdometryFrame& frame, const NodeEstimate& last,
                                     const State& predicted, bool by_imu) {
  MapMatch match;
  match.refusal = MatchRefusal::kNoScan;
  match.T_map_body = toMrpt(predicted.T_map_body);
  if (!frame.scan) return match;
  const double dt_s = secondsBetween(last.t_ns, frame.t_ns);
  const Mat6 covariance = predictedCovariance(last.covariance, dt_s,
                                              sourceOfMotion(by_imu, frame.continues), settings_);
  const bool away = refusals_in_a_row_ > 0 || dt_s > settings_.coasting_after_s;
  const bool lost = away && !start_.pending() && Relocation::lost(covariance);
  StageScope stage(timer_, lost ? "locate" : "match");
  if (lost) {
    const Pose motion = last.state.T_map_body.inverse() * predicted.T_map_body;
    match = relocation_.seek(
        *matcher_, *frame.scan,
        {frame.t_ns, predicted.T_map_body, covariance, predicted.gravity_map, motion});
  } else {
    relocation_.reset();
    match = matchScan(*frame.scan, predicted.T_map_body, covariance);
  }
  match.searched = lost;
  if (match.accepted() && !plausibility_.believes(match, predicted.T_map_body, covariance)) {
    match.refusal = MatchRefusal::kContradiction;
  }
  refusals_in_a_row_ = match.accepted() ? 0 : refusals_in_a_row_ + 1;
  return match;
}

MapMatch TrajectoryGenerator::matchScan(const Scan& scan, const Pose& predicted,
                                        const Mat6& covariance) {
  const double sigma_position =
      std::max(kMinGuessSigmaPosition, std::sqrt(covariance.diagonal().head<3>().sum()));
  const double sigma_rotation =
      std::max(kMinGuessSigmaRotation, std::sqrt(covariance.diagonal().tail<3>().sum()));
  MapMatch match = matcher_->match(scan, toMrpt(predicted), sigma_position, sigma_rotation);
  StartGuess expected = StartGuess::near(toMrpt(predicted));
  expected.search_around = false;
  if (match.accepted() && start_.pending()) return borneOut(*matcher_, scan, expected, match);
  if (!match.accepted() && refusals_in_a_row_ >= settings_.relocate_after_refusals) {
    return matcher_->locate(scan, expected);
  }
  return match;
}

// A body that was lost and is found: a new window begins at this node, and the nodes since it was
// lost come along, for the batch. The old window stays where the new one refuses its first node.
bool TrajectoryGenerator::startAnew(const Pose& T_found_expected, const ChainNode& node) {
  FixedLagSmoother window(settings_.smoother);
  const UpdateSummary begun = window.add(withoutPast(node, settings_));
  if (begun.status == UpdateSummary::Status::kRefused) return false;
  collect(smoother_.window(true));
  for (std::size_t k = firstLost(history_, diagnostics_); k < history_.size(); ++k) {
    displace(T_found_expected, history_[k].node.state);
  }
  repairs_ = repairsSoFar();
  ++repairs_.reanchored;
  smoother_ = std::move(window);
  window_first_ = history_.size();
  plausibility_ = MatchPlausibility(settings_);
  few_points_.forget();
  relocation_.reset();
  return true;
}

// The node's state is the prediction.
void TrajectoryGenerator::addEdgeFactors(const OdometryFrame& frame, const Pose& T_map_body_last,
                                         const std::optional<ImuFactor>& imu, double dt_s,
                                         ChainNode& node, FrameDiagnostics& row) const {
  if (imu) {
    node.edge_factors.push_back(*imu);
  } else {
    // Over a long time it may have gone anywhere, however it moves before and after.
    const bool brief = frame.continues || dt_s < kBriefGap_s;
    node.edge_factors.push_back(VelocityFactor(
        dt_s, brief ? settings_.velocity_sigma_mps : settings_.prior_sigma_velocity_mps));
  }
  node.edge_factors.push_back(BiasWalkFactor(settings_.imu, dt_s));
  node.edge_factors.push_back(ConstantGravityFactor(settings_.gravity_walk_sqrthz, dt_s));
  if (frame.continues) {
    const Pose motion = T_odom_body_last_.inverse() * fromMrpt(frame.T_odom_body);
    const RobustKernel kernel{RobustKernel::Kind::kHuber, settings_.odometry_robust_width};
    node.edge_factors.push_back(LidarOdometryFactor(motion, frame.motion_covariance, kernel));
  } else if (!imu) {
    node.edge_factors.push_back(LidarOdometryFactor(
        T_map_body_last.inverse() * node.state.T_map_body, unmeasuredMotion(dt_s, settings_)));
  }
  row.has_imu_factor = imu.has_value();
  row.has_odometry_factor = frame.continues;
}

void TrajectoryGenerator::addMapFactor(const MapMatch& match, double since_last_s,
                                       ChainNode& node) {
  const double scans = correlation_.add(fromMrpt(match.T_map_body).position, since_last_s);
  node.node_factors.push_back(mapFactorOf(match, scans, settings_.map_robust_width));
}

// ZV and NG hold at every node at rest, NM where the node before rested as well.
void TrajectoryGenerator::addStationaryFactors(TimeNs since_ns, bool rested_before,
                                               ChainNode& node) const {
  const StillnessSettings& s = settings_.stillness;
  node.node_factors.push_back(ZeroVelocityFactor(s.zero_velocity_sigma_mps));
  if (const auto force = stillness_.meanForce(since_ns)) {
    node.node_factors.push_back(
        GravityFactor(*force, s.gravity_sigma_direction_rad, s.gravity_sigma_magnitude));
  }
  if (rested_before) {
    node.edge_factors.push_back(
        NoMotionFactor(s.no_motion_sigma_position_m, s.no_motion_sigma_rotation_rad));
  }
}

// False if the smoother refuses the node. One that was found elsewhere begins a window.
bool TrajectoryGenerator::append(ChainNode node, FrameDiagnostics row,
                                 const std::optional<Pose>& T_found_expected) {
  const std::uint64_t repairs_before = T_found_expected ? 0 : smoother_.repairs().total();
  {
    StageScope stage(timer_, "smooth");
    const bool added = T_found_expected
                           ? startAnew(*T_found_expected, node)
                           : smoother_.add(node).status != UpdateSummary::Status::kRefused;
    if (!added) {
      unused_.add("OdometryFrame", "estimator", "refused by the smoother");
      return false;
    }
  }
  row.repairs = static_cast<int>(smoother_.repairs().total() - repairs_before);
  MapAssociation association = scans_.associate(row.match, node.state.T_map_body);
  row.match.thinned.reset();
  diagnostics_.push_back(std::move(row));
  history_.push_back({std::move(node), diagnostics_.size() - 1, std::move(association)});
  collect(smoother_.takeLeft());
  return true;
}

// Estimates of nodes that leave the window are the online result, and the batch's first guess.
void TrajectoryGenerator::collect(const std::vector<NodeEstimate>& estimates) {
  for (const NodeEstimate& estimate : estimates) {
    HistoryNode& entry = history_[window_first_ + static_cast<std::size_t>(estimate.id)];
    entry.node.state = estimate.state;
    online_.push_back(trajectoryPoint(estimate, entry.association.match));
  }
}

RepairCounts TrajectoryGenerator::repairsSoFar() const {
  RepairCounts sum = repairs_;
  sum += smoother_.repairs();
  return sum;
}

}  // namespace paloc

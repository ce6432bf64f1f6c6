#include "lio_sam_tracker.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace paloc {
namespace {

constexpr double kLeastMatched = 0.1;  // of the features: fewer, and the scan is not used
constexpr int kSettling = 8;           // scans until the first key frame stays where it is
constexpr int kStartRounds = 3;
constexpr int kMostOpen = 8;  // key frames at a place because they leave directions open

RingFeatureLimits ringLimits(const LioSamSettings& s) {
  return {s.feature_window_m, s.edge_bend, s.plane_bend, s.range_noise_m, s.edges_per_sector};
}

KeyFrameLimits mapLimits(const LioSamSettings& s) {
  return {s.voxel_m,
          s.level_factor,
          s.levels,
          s.line_voxel_m,
          static_cast<std::size_t>(s.max_key_frames),
          s.max_distance_m};
}

Vec9 variances(double position_m, double rotation_rad, double velocity_mps) {
  Vec9 sigma;
  sigma << Vec3::Constant(position_m), Vec3::Constant(rotation_rad), Vec3::Constant(velocity_mps);
  return sigma.cwiseAbs2();
}

// What a scan says that the IMU does not cover, and what it says as long as all that it can be
// compared with is the first scan, whose own distortion is not known well.
Vec9 blindness() { return variances(kBlindPosition, kBlindRotation, kBlindVelocity); }
Vec9 unsettled() { return variances(0.005, 0.001, 0.3); }

}  // namespace

LioSamTracker::LioSamTracker(const FrontendSettings& settings)
    : InertialTracker(settings),
      rings_(ringLimits(settings.lio_sam)),
      selection_(settings),
      registration_({settings.lio_sam.max_iterations, settings.lio_sam.noise_floor_m,
                     settings.lio_sam.max_gate_m}),
      smoother_(settings.lio_sam.lag_s, settings.gravity_mps2),
      map_(mapLimits(settings.lio_sam)) {}

LioSamTracker::Outcome LioSamTracker::add(const LidarFrame& frame, const ImuBuffer& imu,
                                          bool has_times) {
  sensor_body_ = frame.T_body_lidar.position;
  const double pause_s = secondsBetween(scan_.end_ns, frame.stamp_ns);
  extractFeatures(frame, has_times);
  if (!begun_ || pause_s > settings_.lio_sam.max_gap_s || smoother_.isLost()) {
    return begin(frame, imu);
  }
  inertia_.follow(timesOf(frame), imu, scan_.end_ns, smoother_.state());
  scan_ = inertia_.scan();
  predict();
  if (first_.scans_since == 0) startMoving();
  FeatureMeasurement measured = align();
  const bool used = measured.matchedShare() >= kLeastMatched;
  if (!used) {
    measured.information.setZero();
    measured.gradient.setZero();
  }
  {
    StageScope stage(timer_, "smoother");
    smoother_.add(scan_.end_ns, measured, blur(), used);
  }
  keepWorst(smoother_.imuFactor());
  StageScope stage(timer_, "map update");
  settleFirst();
  if (used && inertia_.measured()) considerKeyFrame(measured);
  return used ? Outcome::kTracked : Outcome::kCoasted;
}

// The body's velocity is taken as zero until the second scan tells; up is where the mean force
// points.
LioSamTracker::Outcome LioSamTracker::begin(const LidarFrame& frame, const ImuBuffer& imu) {
  LioState state = begun_ ? smoother_.state() : LioState{};
  begun_ = false;
  const auto first = firstScan(timesOf(frame), imu, settings_, state);
  if (!first) return Outcome::kRefused;
  begun_ = true;
  scan_ = first->scan;
  state.v_odom = Vec3::Zero();
  state.gravity_odom = -settings_.gravity_mps2 * (state.T_odom_body.rotation * first->up_body);
  const LioSamSettings& s = settings_.lio_sam;
  start_ = {s.sigma_velocity_mps, s.sigma_acceleration_mps2, s.sigma_bias_acc_mps2,
            s.sigma_bias_gyro_radps};
  if (first->at_rest) {
    start_.sigma_velocity_mps = kRestSpeed;
    start_.sigma_acceleration_mps2 = kRestAcceleration;
  }
  smoother_.begin(scan_.end_ns, state, start_);
  map_.clear();
  first_ = {scan_, state, map_features_, !first->at_rest, 0};
  open_here_ = 0;
  addKeyFrame(true);
  return Outcome::kBegun;
}

// Variances of errors of the last scan of which its own information knows nothing.
Vec9 LioSamTracker::blur() const {
  if (!inertia_.measured()) return blindness();
  const bool settling = first_.moving && first_.scans_since < kSettling;
  return settling ? unsettled() : Vec9::Zero();
}

void LioSamTracker::predict() {
  StageScope stage(timer_, "smoother");
  smoother_.predict(inertia_.motion(), inertia_.noise());
}

// At the second scan: finds the velocity, and places the first key frame anew with it.
void LioSamTracker::startMoving() {
  const Pose predicted = smoother_.predicted().T_odom_body;
  const Pose found = align(true).found.T_odom_body;
  const double dt_s = secondsBetween(first_.scan.end_ns, scan_.end_ns);
  first_.state.v_odom += (found.position - predicted.position) / dt_s;
  const auto beginAnew = [&] {
    smoother_.begin(first_.scan.end_ns, first_.state, start_);
    predict();
    placeFirst(first_.state);
  };
  beginAnew();
  // The body has sped up meanwhile, so the distortions differed a little: once more without them.
  for (int round = 0; round < kStartRounds; ++round) {
    smoother_.add(scan_.end_ns, align(), unsettled(), false);
    const auto first = smoother_.smoothed(first_.scan.end_ns);
    if (first) first_.state.v_odom = first->v_odom;
    beginAnew();
  }
}

// What the next scans tell of the first one's velocity makes its features sharper.
void LioSamTracker::settleFirst() {
  if (++first_.scans_since > kSettling) return;
  if (const auto state = smoother_.smoothed(first_.scan.end_ns)) placeFirst(*state);
}

void LioSamTracker::placeFirst(const LioState& x) {
  placePoints(first_.features.planes, *first_.scan.fall, sensor_body_, x, 1, placed_planes_);
  placePoints(first_.features.edges, *first_.scan.fall, sensor_body_, x, 1, placed_edges_);
  map_.replaceFirst(placed_planes_, placed_edges_);
}

FeatureMeasurement LioSamTracker::align(bool rigid) {
  StageScope stage(timer_, "registration");
  return registration_.align(features_, *scan_.fall, sensor_body_, map_, smoother_.predicted(),
                             smoother_.predictedCovariance(), rigid);
}

// Edges and planes by ring; of a scan without rings its points, of which those count as planes that
// meet one in the map.
void LioSamTracker::extractFeatures(const LidarFrame& frame, bool has_times) {
  StageScope stage(timer_, "features");
  const LioSamSettings& s = settings_.lio_sam;
  const bool by_ring = !frame.ring.empty();
  ++(by_ring ? scans_with_rings_ : scans_without_rings_);
  map_features_.edges.clear();
  if (by_ring) {
    rings_.extract(frame);
    selection_.selectAll(frame, has_times, rings_.edges(), map_features_.edges);
  }
  selection_.select(frame, has_times, static_cast<std::size_t>(s.map_planes),
                    by_ring ? &rings_.planes() : nullptr, map_features_.planes);
  features_.planes =
      everyNth(map_features_.planes, static_cast<std::size_t>(s.registration_planes));
  features_.edges = everyNth(map_features_.edges, static_cast<std::size_t>(s.registration_edges));
}

// Key frames are, besides where the body has moved or the map explains little, some of the scans at
// each place that leave directions open: the map may only have too few points yet to tell, as at
// the start in a stairwell, of whose height one scan alone says too little. What the IMU then makes
// of it would go into all of the map that comes later.
void LioSamTracker::considerKeyFrame(const FeatureMeasurement& measured) {
  const LioSamSettings& s = settings_.lio_sam;
  const Pose motion = last_key_frame_.inverse() * smoother_.state().T_odom_body;
  const bool elsewhere = motion.position.norm() > s.key_frame_distance_m ||
                         so3::log(motion.rotation).norm() > s.key_frame_turn_rad ||
                         measured.matchedShare() < s.key_frame_matched;
  if (elsewhere) {
    open_here_ = 0;
  } else if (measured.open.cols() > 0 && open_here_ < kMostOpen) {
    ++open_here_;
  } else {
    return;
  }
  addKeyFrame();
}

// `rigid` as of FeatureRegistration.
void LioSamTracker::addKeyFrame(bool rigid) {
  const LioState& x = smoother_.state();
  const double ageing = rigid ? 0 : 1;
  placePoints(map_features_.planes, *scan_.fall, sensor_body_, x, ageing, placed_planes_);
  placePoints(map_features_.edges, *scan_.fall, sensor_body_, x, ageing, placed_edges_);
  map_.add(placed_planes_, placed_edges_);
  last_key_frame_ = x.T_odom_body;
}

LidarColumns LioSamTracker::columns() const {
  LidarColumns columns;
  columns.ring = true;
  return columns;
}

std::vector<std::string> LioSamTracker::notes(int scans) const {
  std::vector<std::string> sentences = InertialTracker::notes(scans);
  if (scans_without_rings_ > 0) {
    sentences.push_back((scans_with_rings_ == 0 ? "the scans do" : "some scans do") +
                        std::string(" not tell the ring of their points: lio_sam took no edges "
                                    "from them, planes only"));
  }
  return sentences;
}

}  // namespace paloc

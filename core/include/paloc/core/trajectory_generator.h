#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "paloc/core/estimator_settings.h"
#include "paloc/core/few_point_directions.h"
#include "paloc/core/fixed_lag_smoother.h"
#include "paloc/core/imu_buffer.h"
#include "paloc/core/map_association.h"
#include "paloc/core/map_correlation.h"
#include "paloc/core/map_matcher.h"
#include "paloc/core/match_plausibility.h"
#include "paloc/core/odometry_frame.h"
#include "paloc/core/relocation.h"
#include "paloc/core/smooth_recording.h"
#include "paloc/core/stage_timer.h"
#include "paloc/core/start_tracker.h"
#include "paloc/core/stillness_detector.h"
#include "paloc/core/trajectory.h"
#include "paloc/core/unused_counts.h"

namespace paloc {

/// Which trajectory a run results in: that of all data at once, or what left the fixed-lag window.
enum class Smoothing { kBatch, kOnline };

/// The estimator: odometry frames and IMU samples in, a trajectory in the map's frame out. One node
/// of a fixed-lag smoother per frame; at the end all nodes are smoothed at once.
class PALOC_EXPORT TrajectoryGenerator {
 public:
  TrajectoryGenerator(const EstimatorSettings& settings, std::shared_ptr<MapMatcher> matcher);
  ~TrajectoryGenerator();

  /// What is known of the body's pose in the map at the first frame. A pose up to about 1 m and 10
  /// degrees off is refined by registration; one worse than that, a position, or nothing, by a
  /// search of the map, and what a search finds must be borne out by the scans that follow. What is
  /// not convincing is refused with a reason. Without a guess no start is tried.
  void setInitialGuess(const StartGuess& guess) { start_.setGuess(guess); }
  void setInitialPose(const mrpt::poses::CPose3D& T_map_body);
  /// Told of the stages "match", "preintegrate", "smooth" and "batch"; may be null.
  void setStageTimer(StageTimer* timer) { timer_ = timer; }

  /// In order of time. Trouble in the data is counted, never thrown.
  void add(const FrontendEvent& event);

  /// Poses that have left the fixed-lag window since the last call, oldest first. None while the
  /// start found by search may still be dropped.
  std::vector<TrajectoryPoint> takeOnline();
  /// What happened at the last frame; null before the first.
  const FrameDiagnostics* lastFrame() const;
  /// The smoother's estimate at the last frame that it took; none before the start.
  std::optional<NodeEstimate> newest() const;
  bool started() const { return !history_.empty(); }
  const UnusedCounts& unused() const { return unused_; }

  /// Smooths the whole recording, unless asked not to, and returns everything. Call it once, at the
  /// end.
  Result finish(Smoothing smoothing = Smoothing::kBatch);

 private:
  void addImu(const ImuSample& sample);
  void addFrame(const OdometryFrame& frame);
  void tryStart(const OdometryFrame& frame);
  void start(const OdometryFrame& frame, const MapMatch& match);
  void dropStart();
  void advance(const OdometryFrame& frame);
  MapMatch askMap(const OdometryFrame& frame, const NodeEstimate& last, const State& predicted,
                  bool by_imu);
  MapMatch matchScan(const Scan& scan, const Pose& predicted, const Mat6& covariance);
  bool startAnew(const Pose& T_found_expected, const ChainNode& node);
  void addEdgeFactors(const OdometryFrame& frame, const Pose& T_map_body_last,
                      const std::optional<ImuFactor>& imu, double dt_s, ChainNode& node,
                      FrameDiagnostics& row) const;
  void addMapFactor(const MapMatch& match, double since_last_s, ChainNode& node);
  void addStationaryFactors(TimeNs since_ns, bool rested_before, ChainNode& node) const;
  bool append(ChainNode node, FrameDiagnostics row, const std::optional<Pose>& T_found_expected);
  OdometryFrame sinceLastNode(const OdometryFrame& frame) const;
  OdometryFrame withBestScan(const OdometryFrame& frame, const NodeEstimate& last,
                             const State& predicted, bool by_imu) const;
  std::shared_ptr<const Scan> startScan(const std::shared_ptr<const Scan>& scan) const;
  void rememberOdometry(const Pose& T_odom_body);
  RepairCounts repairsSoFar() const;
  void collect(const std::vector<NodeEstimate>& estimates);
  void setFlags(std::vector<TrajectoryPoint>& points) const;

  EstimatorSettings settings_;
  std::shared_ptr<MapMatcher> matcher_;
  StageTimer* timer_ = nullptr;
  ImuBuffer imu_;
  StillnessDetector stillness_;
  ScanCorrelation correlation_;
  MatchPlausibility plausibility_;
  FewPointDirections few_points_;
  Relocation relocation_;
  FixedLagSmoother smoother_;
  std::size_t window_first_ = 0;  // of the history: the smoother's first node
  RepairCounts repairs_;          // of smoothers before it
  KeptScans scans_;
  StartTracker start_;
  Pose T_odom_body_last_;               // of the last node; before the start, of the last frame
  Mat6 motion_skipped_ = Mat6::Zero();  // covariance of the frames since that gave no node
  bool odometry_broken_ = false;        // one of these began a new stream
  int refusals_in_a_row_ = 0;
  std::vector<HistoryNode> history_;
  std::vector<TrajectoryPoint> online_;
  std::size_t online_taken_ = 0;
  std::vector<FrameDiagnostics> diagnostics_;
  UnusedCounts unused_;
};

}  // namespace paloc

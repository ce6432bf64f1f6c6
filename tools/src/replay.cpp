#include "paloc/tools/replay.h"

#include <chrono>
#include <optional>

#include "paloc/core/text.h"
#include "paloc/core/trajectory_generator.h"
#include "paloc/map/prior_map.h"
#include "paloc/map/scan_matcher.h"
#include "paloc/tools/direction_watch.h"
#include "paloc/tools/event_source.h"
#include "paloc/tools/scan_map.h"
#include "paloc/tools/trajectory_stretches.h"

namespace paloc {
namespace {

constexpr std::size_t kMapSamplePoints = 200'000;
constexpr double kShareToTrust = 0.01;  // of the recording: then the time left can be told

double secondsSince(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

std::vector<Point3f> sampleOf(const PriorMap& map) {
  std::vector<Point3f> sample;
  const auto stride = static_cast<std::uint32_t>(map.size() / kMapSamplePoints + 1);
  for (std::uint32_t k = 0; k < map.size(); k += stride) {
    sample.push_back(map.point(k));
  }
  return sample;
}

class Replay {
 public:
  Replay(const ReplayOptions& options, const Config& config, const std::atomic<bool>& interrupt)
      : options_(options),
        config_(config),
        source_(options, frontendSettingsOf(config), interrupt),
        scan_map_(options.octomap) {
    if (config.matcher.threads > 1) read_ahead_.emplace(source_);
  }

  ReplayOutcome run(const ReplayObserver& observer);

 private:
  void loadMap(const ReplayObserver& observer);
  void makeEstimator();
  std::optional<EventBatch> nextBatch() {
    return read_ahead_ ? read_ahead_->next() : source_.next();
  }
  void take(const EventBatch& batch);
  void watchDirections();
  void report(const ReplayObserver& observer, const EventBatch& batch);
  void finish();
  void tellPlace();
  std::vector<StageTimes> allStages() const;

  const ReplayOptions& options_;
  const Config& config_;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  EventSource source_;  // opened first: a missing recording is found before the map is loaded
  std::optional<ReadAhead> read_ahead_;  // of source_, while the map is loaded, too
  std::shared_ptr<const PriorMap> map_;
  std::unique_ptr<TrajectoryGenerator> generator_;
  StageStopwatch stopwatch_;
  ScanMap scan_map_;
  std::chrono::steady_clock::time_point reading_since_;
  std::uint64_t frames_ = 0;
  std::vector<std::string> untold_;  // of the map and its directions
  DirectionWatch directions_;
  TimeNs watched_ns_ = 0;  // the last frame whose directions were looked at
  ReplayOutcome outcome_;
};

void Replay::loadMap(const ReplayObserver& observer) {
  StageScope stage(&stopwatch_, "load_map");
  map_ = PriorMap::load(options_.map_file, config_.map, [&observer](double share) {
    ReplayProgress progress;
    progress.map_share = share;
    if (observer) observer(progress);
  });
  outcome_.prior_map_points = map_->size();
  outcome_.prior_map_planar = map_->statistics().planar;
  outcome_.unused.add("point", options_.map_file.filename().string(), "not finite",
                      map_->statistics().nonfinite);
  const std::string& note = map_->statistics().side_file_note;
  if (!note.empty()) untold_.push_back(note);
  outcome_.notes = untold_;
  outcome_.prior_map_sample = sampleOf(*map_);
  outcome_.prior_map_origin = map_->origin();
}

void Replay::makeEstimator() {
  generator_ = std::make_unique<TrajectoryGenerator>(config_.estimator,
                                                     ScanMatcher::onto(map_, config_.matcher));
  generator_->setStageTimer(&stopwatch_);
  if (options_.initial) generator_->setInitialGuess(*options_.initial);
}

void Replay::take(const EventBatch& batch) {
  frames_ += batch.frames;
  for (const FrontendEvent& event : batch.events) {
    const auto* frame = std::get_if<OdometryFrame>(&event);
    if (frame) scan_map_.add(*frame);
    const auto* sample = std::get_if<ImuSample>(&event);
    if (sample && options_.keep_imu) outcome_.imu.add(*sample);
    generator_->add(event);
    if (frame) watchDirections();
  }
  outcome_.notes.insert(outcome_.notes.end(), batch.notes.begin(), batch.notes.end());
}

// Of frames that the generator took.
void Replay::watchDirections() {
  const FrameDiagnostics* last = generator_->lastFrame();
  if (!last || last->t_ns == watched_ns_) return;
  watched_ns_ = last->t_ns;
  for (std::string& change : directions_.add(*last)) {
    untold_.push_back(change);
    outcome_.direction_changes.push_back(std::move(change));
  }
}

void Replay::report(const ReplayObserver& observer, const EventBatch& batch) {
  if (!observer || (batch.frames == 0 && batch.notes.empty())) return;
  ReplayProgress progress;
  progress.notes = std::exchange(untold_, {});
  progress.notes.insert(progress.notes.end(), batch.notes.begin(), batch.notes.end());
  progress.share = batch.share;
  const double elapsed_s = secondsSince(reading_since_);
  // What was read ahead while the map was loaded would make the first figures absurd.
  if (elapsed_s > 1) progress.speed_x_realtime = batch.recording_s / elapsed_s;
  if (progress.share > kShareToTrust) {
    progress.left_s = elapsed_s * (1 - progress.share) / progress.share;
  }
  progress.frames = frames_;
  progress.last_frame = generator_->lastFrame();
  progress.started = generator_->started();
  if (const auto newest = generator_->newest()) {
    progress.sigma_m = positionSigmaOf(newest->covariance.topLeftCorner<6, 6>());
  }
  observer(progress);
}

// In the order of the work.
std::vector<StageTimes> Replay::allStages() const {
  std::vector<StageTimes> stages = stopwatch_.stages();
  stages.insert(stages.begin() + 1, source_.stages().begin(), source_.stages().end());
  return stages;
}

void Replay::finish() {
  outcome_.result = generator_->finish(options_.online ? Smoothing::kOnline : Smoothing::kBatch);
  outcome_.unused.merge(source_.unused());
  outcome_.unused.merge(generator_->unused());
  outcome_.findings = source_.findings();
  outcome_.end = source_.runEnd();
  outcome_.recording_s = source_.recordingSeconds();
  {
    StageScope stage(&stopwatch_, "map_of_scans");
    outcome_.map_of_scans = scan_map_.build(outcome_.result.trajectory, options_.output_voxel_m);
  }
  if (options_.octomap && !outcome_.result.trajectory.empty()) {
    outcome_.place =
        placeChanges(*map_, scan_map_, outcome_.result.trajectory, config_, &stopwatch_);
    tellPlace();
  }
  outcome_.stages = allStages();
  outcome_.wall_s = secondsSince(start_);
}

void Replay::tellPlace() {
  const PlaceChanges& place = *outcome_.place;
  if (place.scans_left_out > 0) {
    outcome_.notes.push_back(text("octomap.bt reached octomap.max_memory_mb: the last ",
                                  place.scans_left_out, " scans are not in it"));
  }
  if (place.occupancy->raysOutside() > 0) {
    outcome_.notes.push_back(text("octomap.bt has no room for ", place.occupancy->raysOutside(),
                                  " rays: its cells reach 2^15 cells to each side"));
  }
}

ReplayOutcome Replay::run(const ReplayObserver& observer) {
  loadMap(observer);
  makeEstimator();
  reading_since_ = std::chrono::steady_clock::now();
  while (const std::optional<EventBatch> batch = nextBatch()) {
    take(*batch);
    report(observer, *batch);
  }
  finish();
  return std::move(outcome_);
}

}  // namespace

ReplayOutcome replay(const ReplayOptions& options, const Config& config,
                     const std::atomic<bool>& interrupt, const ReplayObserver& observer) {
  return Replay(options, config, interrupt).run(observer);
}

}  // namespace paloc

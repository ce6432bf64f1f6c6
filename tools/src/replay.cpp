#include "paloc/tools/replay.h"

#include <chrono>

#include "paloc/core/errors.h"
#include "paloc/core/mrpt_pose.h"
#include "paloc/core/text.h"
#include "paloc/core/trajectory_generator.h"
#include "paloc/frontends/mrpt_time.h"
#include "paloc/frontends/odometry_frontend.h"
#include "paloc/frontends/rawlog_stream.h"
#include "paloc/map/prior_map.h"
#include "paloc/map/scan_matcher.h"
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
  Replay(const ReplayOptions& options, const Config& config)
      : options_(options), log_(options.log_file), config_(config) {}

  ReplayOutcome run(const std::atomic<bool>& interrupt, const ReplayObserver& observer);

 private:
  void loadMap();
  void makeEstimator();
  bool wanted(const mrpt::obs::CObservation& observation);
  void drainEvents();
  void report(const ReplayObserver& observer, bool new_frame);
  void finish(const ReplayObserver& observer);
  void noteProblems();

  const ReplayOptions& options_;
  RawlogStream log_;  // opened first: a missing recording is found before the map is loaded
  const Config& config_;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  std::shared_ptr<const PriorMap> map_;
  OdometryFrontend::Ptr frontend_;
  std::unique_ptr<TrajectoryGenerator> generator_;
  StageStopwatch stopwatch_;
  ScanMap scan_map_;
  std::optional<TimeNs> first_ns_;
  TimeNs last_ns_ = 0;
  bool past_end_ = false;
  std::chrono::steady_clock::time_point reading_since_;
  std::uint64_t read_ = 0;  // observations
  std::uint64_t frames_ = 0;
  std::uint64_t outside_span_ = 0;
  ReplayOutcome outcome_;
};

void Replay::loadMap() {
  StageScope stage(&stopwatch_, "load_map");
  map_ = PriorMap::load(options_.map_file, config_.map);
  outcome_.prior_map_points = map_->size();
  outcome_.prior_map_planar = map_->statistics().planar;
  outcome_.unused.add("point", options_.map_file.filename().string(), "not finite",
                      map_->statistics().nonfinite);
  outcome_.prior_map_sample = sampleOf(*map_);
  outcome_.prior_map_origin = map_->origin();
}

void Replay::makeEstimator() {
  frontend_ = OdometryFrontend::create(options_.frontend, config_.frontend);
  generator_ = std::make_unique<TrajectoryGenerator>(config_.estimator,
                                                     ScanMatcher::onto(map_, config_.matcher));
  generator_->setStageTimer(&stopwatch_);
  if (options_.T_map_body_initial) generator_->setInitialPose(toMrpt(*options_.T_map_body_initial));
}

bool Replay::wanted(const mrpt::obs::CObservation& observation) {
  const TimeNs t_ns = fromMrptTime(observation.timestamp);
  if (!first_ns_) first_ns_ = t_ns;
  const double since_start = secondsBetween(*first_ns_, t_ns);
  past_end_ = options_.to_s && since_start > *options_.to_s;
  if (since_start < options_.from_s || past_end_) {
    ++outside_span_;
    return false;
  }
  last_ns_ = std::max(last_ns_, t_ns);
  return true;
}

void Replay::drainEvents() {
  while (true) {
    std::optional<FrontendEvent> event;
    {
      StageScope stage(&stopwatch_, "frontend");
      event = frontend_->next();
    }
    if (!event) return;
    if (const auto* frame = std::get_if<OdometryFrame>(&*event)) {
      ++frames_;
      scan_map_.add(*frame);
    }
    generator_->add(*event);
  }
}

void Replay::report(const ReplayObserver& observer, bool new_frame) {
  ReplayProgress progress;
  progress.notes = frontend_->takeNotes();
  outcome_.notes.insert(outcome_.notes.end(), progress.notes.begin(), progress.notes.end());
  if (!observer || (!new_frame && progress.notes.empty())) return;
  progress.share = log_.progress();
  progress.speed_x_realtime =
      first_ns_ ? secondsBetween(*first_ns_, last_ns_) / std::max(1e-9, secondsSince(start_)) : 0;
  if (progress.share > kShareToTrust) {
    progress.left_s = secondsSince(reading_since_) * (1 - progress.share) / progress.share;
  }
  progress.frames = frames_;
  progress.last_frame = generator_->lastFrame();
  progress.started = generator_->started();
  if (const auto newest = generator_->newest()) {
    progress.sigma_m = positionSigmaOf(newest->covariance.topLeftCorner<6, 6>());
  }
  observer(progress);
}

void Replay::noteProblems() {
  RunEnd& end = outcome_.end;
  if (end.interrupted) return;  // more may have come
  if (read_ == 0) {
    if (end.damage.empty())
      end.problems.push_back(options_.log_file.string() + ": holds no observation");
  } else if (read_ == outside_span_) {
    end.problems.push_back(text("--from and --to leave nothing of the recording: all of ", read_,
                                " observations lie outside"));
  } else {
    end.problems = frontend_->problems();
  }
}

void Replay::finish(const ReplayObserver& observer) {
  {
    StageScope stage(&stopwatch_, "frontend");
    frontend_->finish();
  }
  drainEvents();
  outcome_.result = generator_->finish();
  outcome_.unused.merge(frontend_->unused());
  outcome_.unused.merge(generator_->unused());
  outcome_.unused.add("observations", "all", "outside --from and --to", outside_span_);
  report(observer, false);
  if (log_.end() == RawlogStream::End::kDamaged) outcome_.end.damage = log_.error();
  noteProblems();
  if (read_ > outside_span_) {
    outcome_.recording_s = secondsBetween(*first_ns_, last_ns_) - options_.from_s;
  }
  {
    StageScope stage(&stopwatch_, "map_of_scans");
    outcome_.map_of_scans = scan_map_.build(outcome_.result.trajectory, options_.output_voxel_m);
  }
  outcome_.stages = stopwatch_.stages();
  outcome_.wall_s = secondsSince(start_);
}

ReplayOutcome Replay::run(const std::atomic<bool>& interrupt, const ReplayObserver& observer) {
  loadMap();
  makeEstimator();
  reading_since_ = std::chrono::steady_clock::now();
  while (!past_end_) {
    if (interrupt) {
      outcome_.end.interrupted = true;
      break;
    }
    mrpt::obs::CObservation::Ptr observation;
    {
      StageScope stage(&stopwatch_, "read");
      observation = log_.next();
    }
    if (!observation) break;
    ++read_;
    if (!wanted(*observation)) continue;
    {
      StageScope stage(&stopwatch_, "frontend");
      frontend_->add(*observation);
    }
    const std::uint64_t frames_before = frames_;
    drainEvents();
    report(observer, frames_ != frames_before);
  }
  finish(observer);
  return std::move(outcome_);
}

}  // namespace

ReplayOutcome replay(const ReplayOptions& options, const Config& config,
                     const std::atomic<bool>& interrupt, const ReplayObserver& observer) {
  return Replay(options, config).run(interrupt, observer);
}

}  // namespace paloc

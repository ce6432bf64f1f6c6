#include "paloc/tools/bench_frontends.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "paloc/core/errors.h"
#include "paloc/core/mrpt_pose.h"
#include "paloc/frontends/odometry_frontend.h"
#include "paloc/frontends/rawlog_stream.h"
#include "paloc/tools/simulated_observations.h"
#include "paloc/tools/synth_scene.h"
#include "paloc/tools/trajectory_association.h"
#include "work_stopwatch.h"

namespace paloc {
namespace {

constexpr double kDiverged = 0.1;     // of the way
constexpr double kTruthGap_s = 0.25;  // true poses further apart are not interpolated

using TruthAt = std::function<std::optional<Pose>(TimeNs)>;

/// Processor time of the stages, summed over what belongs to one scan. Stages do not nest.
class ScanStopwatch : public StageTimer {
 public:
  void begin(const char*) override { watch_ = {}; }
  void end(const char* stage) override {
    const double ms = watch_.cpu_ms();
    const auto known = std::find_if(current_.begin(), current_.end(),
                                    [&](const auto& s) { return s.first == stage; });
    if (known == current_.end()) {
      current_.emplace_back(stage, ms);
    } else {
      known->second += ms;
    }
  }

  // All that was measured since the last call belongs to one scan.
  void endScan() {
    double total = 0;
    for (auto& [name, ms] : current_) {
      add(name, ms);
      total += std::exchange(ms, 0);
    }
    add("a scan", total);
  }
  std::vector<StageTimes> take() { return std::move(stages_); }

 private:
  void add(const std::string& name, double ms) {
    auto known = std::find_if(stages_.begin(), stages_.end(),
                              [&](const StageTimes& s) { return s.name == name; });
    if (known == stages_.end()) known = stages_.insert(stages_.end(), {name, {}, 0});
    known->calls_ms.push_back(ms);
    known->total_ms += ms;
  }

  WorkStopwatch watch_;
  std::vector<std::pair<std::string, double>> current_;
  std::vector<StageTimes> stages_;
};

/// Puts observations through a front-end and keeps its poses beside the true ones.
class Runner {
 public:
  Runner(const std::string& name, const FrontendSettings& settings, TruthAt truth,
         ScanStopwatch& stopwatch)
      : frontend_(OdometryFrontend::create(name, settings)),
        truth_(std::move(truth)),
        stopwatch_(stopwatch) {
    frontend_->setStageTimer(&stopwatch_);
  }

  void feed(const mrpt::obs::CObservation& observation) {
    frontend_->add(observation);
    drain();
  }

  FrontendRun finish() {
    frontend_->finish();
    drain();
    run_.figures = odometryFigures(pairs_);
    run_.map_bytes = frontend_->mapBytes();
    run_.notes = frontend_->takeNotes();
    return std::move(run_);
  }

 private:
  void drain() {
    while (const auto event = frontend_->next()) {
      if (const auto* frame = std::get_if<OdometryFrame>(&*event)) keep(*frame);
    }
  }

  void keep(const OdometryFrame& frame) {
    stopwatch_.endScan();
    const auto truth = truth_(frame.t_ns);
    if (!truth) {
      ++run_.without_truth;
      unbroken_ = false;
      return;
    }
    pairs_.push_back({frame.t_ns, fromMrpt(frame.T_odom_body), *truth, frame.continues && unbroken_,
                      frame.motion_covariance});
    unbroken_ = true;
  }

  OdometryFrontend::Ptr frontend_;
  TruthAt truth_;
  ScanStopwatch& stopwatch_;
  std::vector<OdometryPair> pairs_;
  bool unbroken_ = true;  // the frame before has a true pose
  FrontendRun run_;
};

TruthAt truthOf(std::vector<StampedPose> poses) {
  poses = inOrderOfTime(std::move(poses)).poses;
  return [poses = std::move(poses)](TimeNs t_ns) -> std::optional<Pose> {
    const auto after =
        std::lower_bound(poses.begin(), poses.end(), t_ns,
                         [](const StampedPose& pose, TimeNs t) { return pose.t_ns < t; });
    if (after == poses.end()) return std::nullopt;
    if (after->t_ns == t_ns) return after->pose;
    if (after == poses.begin()) return std::nullopt;
    const StampedPose& before = *(after - 1);
    const double gap_s = secondsBetween(before.t_ns, after->t_ns);
    if (gap_s > kTruthGap_s) return std::nullopt;
    return interpolate(before.pose, after->pose, secondsBetween(before.t_ns, t_ns) / gap_s);
  };
}

FrontendRun runLog(const BenchFrontendsSettings& settings, const Config& config,
                   ScanStopwatch& stopwatch, const std::function<void(double)>& progress) {
  Runner runner(settings.frontend, frontendSettingsOf(config), truthOf(readTum(settings.truth)),
                stopwatch);
  RawlogStream log(settings.log);
  while (const auto observation = log.next()) {
    runner.feed(*observation);
    progress(log.progress());
  }
  if (log.end() == RawlogStream::End::kDamaged) throw IoError(log.error());
  return runner.finish();
}

FrontendRun runSimulated(const BenchFrontendsSettings& settings, const synth::Scene& scene,
                         std::uint64_t seed, const Config& config, ScanStopwatch& stopwatch,
                         const std::function<void(double)>& progress) {
  const synth::SensorModel sensor = synth::makeSensor(settings.sensor);
  synth::SynthSettings synth;
  synth.duration_s = settings.duration_s;
  synth.seed = seed;
  const synth::Timeline timeline = synth::makeTimeline(synth, scene.route, sensor);
  const synth::Raycaster raycaster(scene.mesh);
  const synth::Surroundings surroundings(raycaster);
  const synth::LidarSimulator lidar(sensor, synth.T_body_lidar, scene.mesh, surroundings,
                                    timeline.motion, seed);
  FrontendSettings frontend = frontendSettingsOf(config);
  if (!settings.configured_imu) frontend.imu_noise = synth.imu.noise;
  Runner runner(
      settings.frontend, frontend,
      [&](TimeNs t_ns) { return std::optional<Pose>(timeline.motion.at(t_ns).T_map_body); },
      stopwatch);
  synth::simulateObservations(
      timeline, lidar, [&](const auto& observation) { runner.feed(observation); }, progress);
  FrontendRun run = runner.finish();
  run.seed = seed;
  return run;
}

}  // namespace

bool FrontendRun::diverged() const {
  return !(figures.drift_10m_max <= kDiverged && figures.endDrift() <= kDiverged);
}

double BenchFrontendsResult::nees() const {
  double sum = 0, frames = 0;
  for (const FrontendRun& run : runs) {
    const auto n = static_cast<double>(run.figures.normalized.poses);
    sum += n * run.figures.normalized.pose;
    frames += n;
  }
  return frames > 0 ? sum / frames : 0;
}

BenchFrontendsResult benchFrontends(const BenchFrontendsSettings& settings, const Config& config,
                                    const std::function<void(double)>& progress) {
  BenchFrontendsResult result;
  result.settings = settings;
  ScanStopwatch stopwatch;
  if (!settings.log.empty()) {
    result.runs.push_back(runLog(settings, config, stopwatch, progress));
  } else {
    const synth::Scene scene = synth::makeScene(settings.scene);
    for (unsigned i = 0; i < settings.seeds; ++i) {
      result.runs.push_back(
          runSimulated(settings, scene, settings.first_seed + i, config, stopwatch,
                       [&](double share) { progress((i + share) / settings.seeds); }));
    }
  }
  result.stages = stopwatch.take();
  return result;
}

}  // namespace paloc

#include "paloc/tools/bench_corridor.h"

#include <array>
#include <cmath>
#include <numbers>

#include "paloc/core/mrpt_pose.h"
#include "paloc/core/trajectory_generator.h"
#include "paloc/frontends/odometry_frontend.h"
#include "paloc/map/scan_matcher.h"
#include "paloc/tools/simulated_observations.h"
#include "paloc/tools/synth_scene.h"
#include "paloc/tools/synth_timeline.h"

namespace paloc {
namespace {

using synth::kCorridorMouthM;

constexpr double kInRoomsM = 13;  // of the way, before and after the corridor
constexpr double kSpeedMps = 1.05, kStartAndEndS = 6, kPauseS = 4.2, kPauseEveryS = 60;

// Of a walk that ends in the far room (see makeWalk: it rests at both ends and once a minute).
double walkSeconds(double corridor_m) {
  const double moving_s = (corridor_m + kInRoomsM) / kSpeedMps + kStartAndEndS;
  const double pauses = std::max(1.0, std::round(moving_s / kPauseEveryS));
  return moving_s + kPauseS * pauses;
}

synth::SynthSettings synthSettings(const BenchCorridorSettings& settings, double corridor_m) {
  synth::SynthSettings synth;
  synth.duration_s = walkSeconds(corridor_m);
  synth.seed = settings.seed;
  synth.odometry.drift = 0;
  synth.odometry.scale = settings.odometry_scale;
  return synth;
}

/// An estimator, and what it said of every frame when that came.
class Walker {
 public:
  Walker(const Config& config, bool degeneracy_handling, const std::shared_ptr<const PriorMap>& map,
         const Pose& start) {
    run_.degeneracy_handling = degeneracy_handling;
    MatcherSettings matcher = config.matcher;
    matcher.degeneracy_handling = degeneracy_handling;
    generator_ =
        std::make_unique<TrajectoryGenerator>(config.estimator, ScanMatcher::onto(map, matcher));
    generator_->setInitialPose(toMrpt(start));
  }

  void add(const FrontendEvent& event, const synth::Motion& motion) {
    generator_->add(event);
    const auto newest =
        std::holds_alternative<OdometryFrame>(event) ? generator_->newest() : std::nullopt;
    if (!newest || newest->t_ns != std::get<OdometryFrame>(event).t_ns) return;
    run_.online_poses.push_back({newest->t_ns, motion.at(newest->t_ns).T_map_body,
                                 newest->state.T_map_body, newest->covariance.topLeftCorner<6, 6>(),
                                 PoseFlag::kGood});
  }

  CorridorRun finish(const synth::Motion& motion, const FreeStretch& stretch) {
    const Result result = generator_->finish();
    for (const TrajectoryPoint& p : result.trajectory) {
      run_.batch_poses.push_back(
          {p.t_ns, motion.at(p.t_ns).T_map_body, fromMrpt(p.T_map_body), p.covariance, p.flag});
    }
    // The flags belong to the scans: they are told of both.
    for (std::size_t k = 0; k < std::min(run_.online_poses.size(), result.online.size()); ++k) {
      run_.online_poses[k].flag = result.online[k].flag;
    }
    for (const FrameDiagnostics& frame : result.diagnostics) {
      ++(frame.match.accepted() ? run_.map_factors : run_.refused);
    }
    run_.online = corridorFigures(run_.online_poses, stretch);
    run_.batch = corridorFigures(run_.batch_poses, stretch);
    return std::move(run_);
  }

 private:
  std::unique_ptr<TrajectoryGenerator> generator_;
  CorridorRun run_;
};

/// Puts a recording that nobody stores through the front-end and into both estimators.
void walkThrough(const synth::Timeline& timeline, const synth::LidarSimulator& lidar,
                 const FrontendSettings& settings, const std::array<Walker*, 2>& walkers,
                 const BenchCorridorProgress& progress) {
  const auto frontend = OdometryFrontend::create("recorded", settings);
  const auto drain = [&] {
    while (const auto event = frontend->next()) {
      for (Walker* walker : walkers) walker->add(*event, timeline.motion);
    }
  };
  synth::simulateObservations(
      timeline, lidar,
      [&](const mrpt::obs::CObservation& observation) {
        frontend->add(observation);
        drain();
      },
      progress);
  frontend->finish();
  drain();
}

std::vector<Pose> posesOf(const std::vector<StampedPose>& stamped) {
  std::vector<Pose> poses;
  for (const StampedPose& s : stamped) poses.push_back(s.pose);
  return poses;
}

}  // namespace

BenchCorridorResult benchCorridor(const BenchCorridorSettings& settings, const Config& config,
                                  const BenchCorridorProgress& progress) {
  const synth::SensorModel sensor = synth::makeSensor(settings.sensor);
  const double corridor_m = settings.free_m + 2 * kCorridorMouthM;
  const synth::Scene scene = synth::makeCorridor(settings.angle_deg, corridor_m);
  const synth::SynthSettings synth = synthSettings(settings, corridor_m);
  const synth::Timeline timeline = synth::makeTimeline(synth, scene.route, sensor);
  const synth::Raycaster raycaster(scene.mesh);
  const synth::Surroundings surroundings(raycaster);
  const synth::LidarSimulator lidar(sensor, synth.T_body_lidar, scene.mesh, surroundings,
                                    timeline.motion, settings.seed);
  Config noisy = config;
  noisy.matcher.range_noise_m = sensor.range_noise_m;
  const auto map = PriorMap::build(
      synth::survey(settings.survey, scene.mesh, raycaster, scene.survey_stations, settings.seed),
      noisy.map, "corridor");

  BenchCorridorResult result;
  result.settings = settings;
  result.scans = timeline.scans;
  const double yaw = settings.angle_deg * std::numbers::pi / 180;
  result.stretch = {so3::exp(Vec3(0, 0, yaw)) * Vec3::UnitX(), kCorridorMouthM,
                    corridor_m - kCorridorMouthM};
  result.odometry_drift_m =
      odometryDrift(posesOf(timeline.truth), posesOf(timeline.odometry), result.stretch);
  const Pose start = timeline.truth.front().pose;
  Walker handled(noisy, true, map, start), unhandled(noisy, false, map, start);
  walkThrough(timeline, lidar, frontendSettingsOf(noisy), {&handled, &unhandled}, progress);
  result.handled = handled.finish(timeline.motion, result.stretch);
  result.unhandled = unhandled.finish(timeline.motion, result.stretch);
  return result;
}

}  // namespace paloc

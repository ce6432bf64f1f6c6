#include "paloc/tools/synth_recording.h"

#include <tbb/global_control.h>
#include <tbb/info.h>
#include <tbb/parallel_pipeline.h>
#include <tbb/task_arena.h>

#include <nlohmann/json.hpp>
#include <numbers>

#include "paloc/core/errors.h"
#include "paloc/core/mrpt_pose.h"
#include "paloc/frontends/mrpt_time.h"
#include "paloc/frontends/rawlog_stream.h"
#include "paloc/frontends/tum_file.h"
#include "paloc/map/cloud_io.h"
#include "paloc/tools/motion_observations.h"
#include "paloc/tools/result_folder.h"
#include "paloc/tools/synth_changed_scene.h"
#include "paloc/tools/synth_fault_injector.h"
#include "paloc/tools/synth_map_scene.h"
#include "paloc/tools/synth_scene.h"
#include "paloc/tools/synth_sensor.h"
#include "paloc/tools/synth_timeline.h"
#include "paloc/tools/synth_writers.h"
#include "timeline_feed.h"

namespace paloc::synth {
namespace {

constexpr double kSurveyShare = 0.2;  // of the time, roughly

/// Writes the observations in the order of their stamps: scans as they come, and before each the
/// IMU samples and odometry poses that are older.
class OrderedRecording {
 public:
  OrderedRecording(const std::filesystem::path& file, const Timeline& timeline,
                   const SynthSettings& settings)
      : feed_(timeline),
        faults_(settings.faults, timeline.first_scan_ns),
        writer_(file, settings.gzip ? RawlogWriter::Compression::kGzip
                                    : RawlogWriter::Compression::kNone) {
    if (!settings.blackout_s) return;
    dark_from_ns_ = timeline.first_scan_ns + nsFromSeconds((*settings.blackout_s)[0]);
    dark_to_ns_ = timeline.first_scan_ns + nsFromSeconds((*settings.blackout_s)[1]);
  }

  void writeScan(const obs::CObservationLidarScan& scan) {
    writeUntil(fromMrptTime(scan.timestamp));
    write(scan);
  }
  void close() {
    writeUntil(std::numeric_limits<TimeNs>::max());
    writer_.close();
  }

 private:
  void writeUntil(TimeNs end_ns) {
    feed_.until(end_ns, [&](const auto& observation) { write(observation); });
  }
  void write(const mrpt::obs::CObservation& observation) {
    const TimeNs t_ns = fromMrptTime(observation.timestamp);
    if (t_ns >= dark_from_ns_ && t_ns < dark_to_ns_) return;
    faults_.pass(observation, [this](const auto& spoiled) { writer_.write(spoiled); });
  }

  TimelineFeed feed_;
  FaultInjector faults_;
  RawlogWriter writer_;
  TimeNs dark_from_ns_ = 0, dark_to_ns_ = 0;
};

/// Simulates the scans on all threads, and writes them in order as they are ready; a few at a time
/// are in memory.
void writeScans(const Timeline& timeline, const LidarSimulator& lidar, OrderedRecording& recording,
                SynthSummary& summary, const SynthProgress& progress) {
  struct Job {
    std::size_t index = 0;
    obs::CObservationLidarScan::Ptr scan;
  };
  std::size_t next = 0;
  const auto in_flight = static_cast<std::size_t>(4 * tbb::this_task_arena::max_concurrency());
  tbb::parallel_pipeline(
      in_flight,
      tbb::make_filter<void,
                       Job>(tbb::filter_mode::serial_in_order, [&](tbb::flow_control& flow) -> Job {
        if (next == timeline.scans) flow.stop();
        return {next++, nullptr};
      }) & tbb::make_filter<Job, Job>(tbb::filter_mode::parallel, [&](Job job) {
        job.scan = lidar.scan(job.index, timeline.scanStart(job.index));
        return job;
      }) & tbb::make_filter<Job, void>(tbb::filter_mode::serial_in_order, [&](const Job& job) {
        recording.writeScan(*job.scan);
        summary.points += job.scan->size();
        if (job.scan->size() == 0) ++summary.scans_without_returns;
        const double share =
            static_cast<double>(job.index + 1) / static_cast<double>(timeline.scans);
        progress((1 - kSurveyShare) * share, "recording.rawlog");
      }));
}

Scene sceneOf(const SynthSettings& settings) {
  if (settings.map_file.empty()) return makeScene(settings.scene);
  return makeMapScene(settings.map_file, settings.trajectory.empty());
}

double endError(const Timeline& timeline) {
  const Pose T_map_odom = timeline.truth.front().pose * timeline.odometry.front().pose.inverse();
  return (T_map_odom * timeline.odometry.back().pose.position - timeline.truth.back().pose.position)
      .norm();
}

void addCounts(const Timeline& timeline, const SensorModel& sensor, SynthSummary& summary) {
  summary.scans = timeline.scans;
  summary.imu_samples = timeline.imu.size();
  summary.odometry_poses = timeline.odometry.size();
  summary.duration_s = secondsBetween(timeline.first_scan_ns,
                                      timeline.scanStart(timeline.scans - 1) + sensor.duration());
  summary.length_m = timeline.length_m;
  summary.odometry_end_error_m = endError(timeline);
  summary.notes = timeline.notes;
}

}  // namespace

Pose defaultExtrinsic() {
  constexpr double kDegree = std::numbers::pi / 180;
  return fromMrpt(
      mrpt::poses::CPose3D(-0.037, 0.008, -0.023, 1.0 * kDegree, 0.6 * kDegree, -0.4 * kDegree));
}

SynthSummary writeRecording(const SynthSettings& settings, const SynthProgress& progress) {
  const int threads = settings.threads > 0 ? settings.threads : tbb::info::default_concurrency();
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism,
                                  static_cast<std::size_t>(threads));
  const Scene scene = sceneOf(settings);
  SensorModel sensor = makeSensor(settings.sensor);
  if (settings.range_noise_m) sensor.range_noise_m = *settings.range_noise_m;
  const Timeline timeline = makeTimeline(settings, scene.route, sensor);
  const ResultFolder folder(settings.folder, settings.overwrite);
  const Raycaster raycaster(scene.mesh);
  const ChangedScene changed = changeScene(scene, settings.changes, timeline.motion, raycaster);
  const Raycaster changed_raycaster(changed.mesh);
  const Surroundings surroundings = changed.surroundings(changed_raycaster);

  SynthSummary summary;
  addCounts(timeline, sensor, summary);
  writeTum(folder.file("truth.tum"), timeline.truth);
  writeImuTruth(folder.file("truth_imu.csv"), timeline.imu);
  const LidarSimulator lidar(sensor, settings.T_body_lidar, changed.mesh, surroundings,
                             timeline.motion, settings.seed);
  OrderedRecording recording(folder.file("recording.rawlog"), timeline, settings);
  writeScans(timeline, lidar, recording, summary, progress);
  recording.close();
  if (summary.scans_without_returns > 0) {
    summary.notes.push_back(std::to_string(summary.scans_without_returns) + " of " +
                            std::to_string(summary.scans) +
                            " scans hit nothing: the path leaves the scene");
  }
  summary.files = {folder.file("recording.rawlog"), folder.file("truth.tum"),
                   folder.file("truth_imu.csv")};
  if (!scene.survey_stations.empty()) {
    progress(1 - kSurveyShare, "map.ply");
    PointCloud map =
        survey(settings.survey, scene.mesh, raycaster, scene.survey_stations, settings.seed);
    changed.cut(map);
    summary.map_points = map.size();
    savePly(folder.file("map.ply"), map, "paloc synth, scene " + settings.scene);
    summary.files.push_back(folder.file("map.ply"));
  }
  writeDescription(folder.file("synth.json"), settings, scene, sensor, summary);
  if (!settings.changes.empty()) {
    writeTextFile(folder.file("changes.json"), describeChanges(changed).dump(1) + '\n');
    summary.files.push_back(folder.file("changes.json"));
  }
  progress(1, "synth.json");
  summary.files.push_back(folder.file("synth.json"));
  return summary;
}

}  // namespace paloc::synth

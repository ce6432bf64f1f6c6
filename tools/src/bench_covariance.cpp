#include "paloc/tools/bench_covariance.h"

#include <atomic>
#include <filesystem>

#include "paloc/core/errors.h"
#include "paloc/core/mrpt_pose.h"
#include "paloc/tools/eval_covariance.h"
#include "paloc/tools/replay.h"
#include "paloc/tools/synth_recording.h"
#include "temporary_folder.h"

namespace paloc {
namespace {

constexpr double kSameStamp_s = 1e-3;

synth::SynthSettings synthSettings(const BenchCovarianceSettings& settings,
                                   const std::string& place, std::uint64_t seed) {
  synth::SynthSettings synth;
  const std::size_t plus = place.find('+');
  synth.scene = place.substr(0, plus);
  if (plus != std::string::npos)
    synth.changes.push_back(synth::parseChange(place.substr(plus + 1)));
  synth.sensor = settings.sensor;
  synth.duration_s = settings.duration_s;
  synth.seed = seed;
  synth.survey.surface_bias_m = settings.map_bias_m;
  return synth;
}

/// Adds up the seeds of one place.
class PlaceRun {
 public:
  // One recording, made, replayed and compared with its truth.
  void add(synth::SynthSettings synth, const std::string& frontend, const Config& config) {
    const TemporaryFolder folder;
    synth.folder = folder.path();
    writeRecording(synth, [](double, const std::string&) {});
    const std::vector<StampedPose> truth = readTum(folder.path() / "truth.tum");
    ReplayOptions options;
    options.log_file = folder.path() / "recording.rawlog";
    options.map_file = folder.path() / "map.ply";
    options.frontend = frontend;
    options.initial = StartGuess::near(toMrpt(truth.front().pose));
    const std::atomic<bool> interrupt{false};
    const ReplayOutcome outcome = replay(options, config, interrupt, [](const ReplayProgress&) {});
    if (outcome.result.trajectory.empty()) {
      ++place_.failed;
      return;
    }
    compare(truth, covariantPoses(outcome.result.trajectory));
  }

  PlaceCovariance result() {
    place_.all = all_.result();
    for (const auto& [flag, sums] : by_flag_) place_.by_flag.emplace(flag, sums.result());
    return std::move(place_);
  }

 private:
  void compare(const std::vector<StampedPose>& truth, const std::vector<CovariantPose>& estimate) {
    NormalizedErrorSums seed;
    std::size_t k = 0;
    for (const CovariantPose& row : estimate) {
      while (k < truth.size() && secondsBetween(truth[k].t_ns, row.pose.t_ns) > kSameStamp_s) ++k;
      if (k == truth.size()) break;
      if (secondsBetween(row.pose.t_ns, truth[k].t_ns) > kSameStamp_s) continue;
      if (!seed.add(row.pose.pose, truth[k].pose, row.covariance)) {
        ++place_.unusable;
        continue;
      }
      all_.add(row.pose.pose, truth[k].pose, row.covariance);
      by_flag_[row.flag].add(row.pose.pose, truth[k].pose, row.covariance);
    }
    place_.nees_per_seed.push_back(seed.result().pose);
  }

  PlaceCovariance place_;
  NormalizedErrorSums all_;
  std::map<std::string, NormalizedErrorSums> by_flag_;
};

}  // namespace

BenchCovarianceResult benchCovariance(const BenchCovarianceSettings& settings, Config config,
                                      const std::function<void(double)>& progress) {
  config.map.side_file = false;
  config.matcher.plane_bias_m = settings.map_bias_m;
  config.matcher.range_bias_m = 0;  // the simulated sensors have none
  if (!settings.configured_imu) config.estimator.imu = synth::SynthSettings().imu.noise;
  const std::size_t runs = settings.places.size() * settings.seeds;
  std::size_t done = 0;
  BenchCovarianceResult result;
  for (const std::string& place : settings.places) {
    PlaceRun run;
    for (unsigned seed = 0; seed < settings.seeds; ++seed) {
      run.add(synthSettings(settings, place, settings.first_seed + seed), settings.frontend,
              config);
      progress(static_cast<double>(++done) / static_cast<double>(runs));
    }
    result.places.emplace_back(place, run.result());
  }
  return result;
}

}  // namespace paloc

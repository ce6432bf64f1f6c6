#include <CLI/CLI.hpp>
#include <chrono>
#include <cstdio>
#include <iostream>
#include <nlohmann/json.hpp>

#include "paloc/core/errors.h"
#include "paloc/core/mrpt_pose.h"
#include "paloc/tools/commands.h"
#include "paloc/tools/parse_pose.h"
#include "paloc/tools/progress_line.h"
#include "paloc/tools/synth_recording.h"
#include "paloc/tools/synth_scene.h"
#include "paloc/tools/synth_sensor.h"

namespace paloc {
namespace {

std::string joined(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : ", ") + name;
  return text;
}

class SynthCommand : public Command {
 public:
  void registerOn(CLI::App& app) override;
  bool called() const override { return command_->parsed(); }
  ExitCode run() override;

 private:
  void addModelOptions();
  void printSummary(const synth::SynthSummary& summary, double time_s) const;

  CLI::App* command_ = nullptr;
  synth::SynthSettings settings_;
  std::string map_, trajectory_, folder_, extrinsic_;
  std::vector<std::string> changes_, faults_;
  double range_noise_m_ = -1;
  std::vector<double> blackout_s_;
  bool json_ = false;
};

void SynthCommand::registerOn(CLI::App& app) {
  command_ = app.add_subcommand("synth", "Simulate a recording, its prior map and its truth");
  command_->add_option("--scene", settings_.scene, "where: " + joined(synth::sceneNames()))
      ->capture_default_str();
  command_
      ->add_option(
          "--map", map_,
          "where instead: an OctoMap file (.bt, .ot), which is then the prior map; without "
          "--trajectory, a way is sought in its free space")
      ->excludes("--scene");
  command_->add_option("--sensor", settings_.sensor, "LiDAR: " + joined(synth::sensorNames()))
      ->capture_default_str();
  command_->add_option(
      "--trajectory", trajectory_,
      "path of the body in the scene's frame (TUM), instead of a walk; smoothed by 0.15 s");
  command_->add_option("--duration", settings_.duration_s, "length of the recording (s)")
      ->check(CLI::Range(0.1, 3600.0))
      ->capture_default_str();
  command_->add_option("--seed", settings_.seed, "of all random numbers: same seed, same bytes")
      ->capture_default_str();
  addModelOptions();
  command_->add_option("-o,--output", folder_, "folder to write to")->required();
  command_->add_flag("--gzip", settings_.gzip, "compress the recording (40 ms a scan)");
  command_->add_flag("--overwrite", settings_.overwrite, "replace files of an earlier run");
  command_->add_option("-j,--threads", settings_.threads, "threads; 0: all processors")
      ->check(CLI::Range(0, 256))
      ->capture_default_str();
  command_->add_flag("--json", json_, "print a JSON object");
  command_->footer(
      "Writes recording.rawlog, map.ply, truth.tum (pose of the body in the map at the end of "
      "each\n"
      "scan), truth_imu.csv (with velocity and biases, at IMU rate) and synth.json (all parameters "
      "and\n"
      "frames); with --change also changes.json, which tells where.\n\nFaults, with the values "
      "that they have unless told otherwise (times count from the first scan;\n"
      "the truth stays that of the motion):\n" +
      synth::faultHelp() +
      "\nExample: paloc synth --scene building --sensor os1-128 --duration 60 -o demo\n"
      "         paloc synth --fault imu-g --fault clock-offset=-0.005 -o faulty");
}

void SynthCommand::addModelOptions() {
  command_->add_option("--odometry-drift", settings_.odometry.drift, "share of the way, over 10 m")
      ->check(CLI::Range(0.0, 1.0))
      ->capture_default_str();
  command_
      ->add_option("--odometry-scale", settings_.odometry.scale,
                   "length of the odometry's steps over the true one, besides the drift")
      ->check(CLI::Range(0.5, 2.0))
      ->capture_default_str();
  command_
      ->add_option("--range-noise", range_noise_m_,
                   "of the LiDAR (m, one sigma); else the sensor's own")
      ->check(CLI::Range(0.0, 1.0));
  command_
      ->add_option("--map-bias", settings_.survey.surface_bias_m,
                   "shift of whole surfaces in the map (m, one sigma)")
      ->check(CLI::Range(0.0, 0.1))
      ->capture_default_str();
  command_->add_option("--map-spacing", settings_.survey.spacing_m, "edge of the map's voxels (m)")
      ->check(CLI::Range(0.005, 1.0))
      ->capture_default_str();
  command_->add_option("--change", changes_,
                       "what differs from the surveyed place (several may be given; moved-wall=0.3 "
                       "tells metres, walking-people=4 how many): " +
                           joined(synth::changeNames()));
  command_->add_option("--fault", faults_,
                       "what is wrong with the recording (several may be given); see below");
  command_
      ->add_option("--blackout", blackout_s_,
                   "from, to (s): nothing is recorded, while the platform goes on")
      ->expected(2)
      ->check(CLI::NonNegativeNumber);
  command_->add_option(
      "--T-body-lidar", extrinsic_,
      "x,y,z,yaw,pitch,roll (m, degrees) of the LiDAR in the body: p_body = T p_lidar");
}

ExitCode SynthCommand::run() {
  settings_.map_file = map_;
  settings_.trajectory = trajectory_;
  settings_.folder = folder_;
  if (range_noise_m_ >= 0) settings_.range_noise_m = range_noise_m_;
  if (!blackout_s_.empty()) {
    if (!(blackout_s_[0] < blackout_s_[1])) {
      throw UsageError("--blackout: the second time must be after the first");
    }
    settings_.blackout_s = {blackout_s_[0], blackout_s_[1]};
  }
  if (!extrinsic_.empty()) {
    settings_.T_body_lidar = fromMrpt(parsePose(extrinsic_, "--T-body-lidar"));
  }
  for (const std::string& fault : faults_) settings_.faults.push_back(synth::parseFault(fault));
  for (const std::string& change : changes_) {
    settings_.changes.push_back(synth::parseChange(change));
  }
  ProgressLine line;
  std::string last_file;
  const auto progress = [&](double share, const std::string& file) {
    char text[80];
    std::snprintf(text, sizeof text, "%3.0f %%  %s", 100 * share, file.c_str());
    line.show(text, file != last_file);
    last_file = file;
  };
  const auto start = std::chrono::steady_clock::now();
  const synth::SynthSummary summary = writeRecording(settings_, progress);
  line.finish();
  const std::chrono::duration<double> time = std::chrono::steady_clock::now() - start;
  printSummary(summary, time.count());
  return ExitCode::kGood;
}

void SynthCommand::printSummary(const synth::SynthSummary& summary, double time_s) const {
  for (const std::string& note : summary.notes)
    std::fprintf(stderr, "paloc synth: %s\n", note.c_str());
  if (json_) {
    nlohmann::ordered_json json;
    json["folder"] = settings_.folder.string();
    json["scans"] = summary.scans;
    json["points"] = summary.points;
    json["scans_without_returns"] = summary.scans_without_returns;
    json["imu_samples"] = summary.imu_samples;
    json["odometry_poses"] = summary.odometry_poses;
    json["map_points"] = summary.map_points;
    json["duration_s"] = summary.duration_s;
    json["length_m"] = summary.length_m;
    json["odometry_end_error_m"] = summary.odometry_end_error_m;
    json["notes"] = summary.notes;
    json["time_s"] = time_s;
    std::cout << json.dump(2) << '\n';
    return;
  }
  std::printf(
      "%zu scans with %.1f million points, %zu IMU samples, %zu odometry poses over %.1f s and "
      "%.1f m\n",
      summary.scans, static_cast<double>(summary.points) * 1e-6, summary.imu_samples,
      summary.odometry_poses, summary.duration_s, summary.length_m);
  std::printf("the odometry ends %.2f m off", summary.odometry_end_error_m);
  if (summary.map_points > 0) std::printf("; the map has %zu points", summary.map_points);
  std::printf("\nwritten to %s in %.1f s\n", settings_.folder.string().c_str(), time_s);
}

}  // namespace

std::unique_ptr<Command> makeSynthCommand() { return std::make_unique<SynthCommand>(); }

}  // namespace paloc

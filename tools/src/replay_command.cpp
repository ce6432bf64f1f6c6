#include <CLI/CLI.hpp>
#include <csignal>
#include <cstdio>
#include <iostream>
#include <sstream>

#include "paloc/core/errors.h"
#include "paloc/frontends/tum_file.h"
#include "paloc/tools/commands.h"
#include "paloc/tools/config_options.h"
#include "paloc/tools/dense_output.h"
#include "paloc/tools/html_text.h"
#include "paloc/tools/plugin_option.h"
#include "paloc/tools/progress_line.h"
#include "paloc/tools/replay.h"
#include "paloc/tools/replay_summary.h"
#include "paloc/tools/replay_writers.h"
#include "paloc/tools/result_folder.h"
#include "paloc/tools/start_options.h"

namespace paloc {
namespace {

constexpr const char* kExample = R"(Example:
  paloc replay recording.rawlog --map map.ply --init-pose 1.2,0.4,1.6,90,0,0 -o result
  paloc replay recording.rawlog --map map.ply --init auto --set smoother.lag_s=10

The pose written for a scan is that of the body at the scan's end, in the map's frame.
Exit codes: 0 all poses good, 1 finished but part of the result is flagged, 2 wrong usage or
configuration, 3 an input file is wrong, 4 no localization, 5 internal error.)";

std::atomic<bool> interrupted{false};

extern "C" void onInterrupt(int) {
  interrupted = true;
  std::signal(SIGINT, SIG_DFL);  // a second Ctrl-C ends the program at once
}

std::string matchText(const MapMatch& match) {
  if (!match.accepted()) return "no map factor: " + toString(match.refusal);
  char buffer[100];
  std::snprintf(buffer, sizeof buffer, "inliers %d of %d  residual %.1f mm", match.inliers,
                match.points, 1000 * match.residual_rms_m);
  return buffer;
}

std::string progressText(const ReplayProgress& p) {
  char buffer[100];
  if (p.map_share) {
    std::snprintf(buffer, sizeof buffer, "reading the map: %3.0f %%", 100 * *p.map_share);
    return buffer;
  }
  std::snprintf(buffer, sizeof buffer, "%3.0f %%", 100 * p.share);
  std::string text = buffer;
  if (p.speed_x_realtime > 0) {
    std::snprintf(buffer, sizeof buffer, "  %.1f x real time", p.speed_x_realtime);
    text += buffer;
  }
  if (p.left_s) {
    std::snprintf(buffer, sizeof buffer, "  %.0f s left", *p.left_s);
    text += buffer;
  }
  text += "  " + std::to_string(p.frames) + " scans";
  if (!p.started) text += "  no start yet";
  if (p.last_frame) text += "  " + matchText(p.last_frame->match);
  if (p.sigma_m) text += "  sigma " + lengthText(*p.sigma_m);
  return text;
}

class ReplayCommand : public Command {
 public:
  void registerOn(CLI::App& app) override {
    replay_ = app.add_subcommand("replay", "Make a trajectory of a recording and a prior map");
    replay_->add_option("LOG", options_.log_file, "recording (MRPT rawlog)")->required();
    replay_
        ->add_option("--map", options_.map_file,
                     "prior map (PLY, PCD, LAS, XYZ text, OctoMap; gzipped or not)")
        ->required();
    replay_->add_option("--frontend", options_.frontend, "odometry front-end")
        ->capture_default_str();
    plugins_.registerOn(*replay_);
    start_.registerOn(*replay_, "at the first scan");
    start_.registerTumOn(*replay_);
    replay_->add_option("--from", options_.from_s, "skip this much of the recording (s)")
        ->check(CLI::NonNegativeNumber);
    replay_->add_option("--to", to_s_, "stop this long after the recording's start (s)")
        ->check(CLI::PositiveNumber);
    replay_->add_flag(
        "--online", options_.online,
        "write what left the fixed-lag window, instead of smoothing all data at once");
    replay_
        ->add_option("--rate", rate_, "besides, poses at the stamps of the IMU: trajectory_imu.*")
        ->check(CLI::IsMember({"scan", "imu"}))
        ->capture_default_str();
    replay_->add_option("--stamps", stamps_file_,
                        "besides, poses at the stamps in this file (s, first field of a line): "
                        "trajectory_stamps.*");
    replay_->add_flag("--octomap", options_.octomap,
                      "besides, octomap.bt: which space is free and occupied, and "
                      "map_changes.ply: what differs from the prior map");
    replay_->add_option("-j", threads_, "threads; the result is the same for any number")
        ->check(CLI::Range(1, 256));
    replay_->add_option("-o,--output", output_, "result folder")->capture_default_str();
    replay_->add_flag("--overwrite", overwrite_, "replace result files that are there already");
    replay_->add_flag("--json", json_, "print summary.json on standard output, and nothing else");
    replay_->add_flag("--no-side-file", no_side_file_,
                      "neither read nor write MAP.paloc, which makes the next start quick");
    config_.registerOn(*replay_);
    replay_->footer(kExample);
  }

  bool called() const override { return replay_->parsed(); }

  ExitCode run() override {
    Config config = config_.load();
    if (threads_ > 0) config.map.threads = config.matcher.threads = threads_;
    if (no_side_file_) config.map.side_file = false;
    checkConfig(config);
    options_.initial = start_.guess();
    if (to_s_ > 0) options_.to_s = to_s_;
    if (options_.to_s && *options_.to_s <= options_.from_s) {
      throw UsageError("--to must be later than --from: both count from the recording's start");
    }
    if (!stamps_file_.empty()) stamps_ = readStamps(stamps_file_);
    options_.keep_imu = rate_ == "imu" || !stamps_.empty();
    plugins_.load();
    const ResultFolder folder(output_, overwrite_);

    std::signal(SIGINT, onInterrupt);
    ProgressLine progress;
    const ReplayOutcome outcome =
        replay(options_, config, interrupted, [&](const ReplayProgress& p) {
          for (const std::string& note : p.notes) progress.say("note: " + note);
          progress.show(progressText(p));
        });
    progress.finish();
    std::signal(SIGINT, SIG_DFL);
    return tell(folder, config, outcome);
  }

 private:
  // What came out is told even if it cannot be written: it may have taken hours.
  ExitCode tell(const ResultFolder& folder, const Config& config,
                const ReplayOutcome& outcome) const {
    std::string not_written, dense;
    try {
      writeResult(folder, options_, config, outcome, commandLine());
      dense = writeDense(folder, config, outcome);
    } catch (const IoError& e) {
      not_written = e.what();
    }
    std::ostream& table = json_ ? std::cerr : std::cout;
    table << summaryText(outcome) << dense;
    if (json_) std::cout << summaryJson(outcome).dump(2) << '\n';
    if (!not_written.empty()) throw IoError(not_written);
    table << "results in       " << folder.path().string() << " (report.html)\n";
    if (!std::cout.flush()) throw IoError("standard output: cannot be written");
    return verdictOf(outcome).code;
  }

  // The dense outputs that were asked for; returns what to tell of them.
  std::string writeDense(const ResultFolder& folder, const Config& config,
                         const ReplayOutcome& outcome) const {
    if (!options_.keep_imu || outcome.result.trajectory.empty()) return {};
    const DenseTrajectory dense(outcome.result, outcome.imu, config.estimator,
                                config.frontend.max_odometry_gap_s);
    std::string told;
    if (rate_ == "imu") {
      told += "at IMU rate      " +
              writeDensePoses(folder, "trajectory_imu", posesAt(dense, dense.imuStamps()));
    }
    if (!stamps_.empty()) {
      told += "at given stamps  " +
              writeDensePoses(folder, "trajectory_stamps", posesAt(dense, stamps_));
    }
    return told;
  }

  // As the user would type it again.
  std::string commandLine() const {
    std::ostringstream line;
    line << "paloc replay " << options_.log_file << " --map " << options_.map_file << " --frontend "
         << options_.frontend << " --config config_effective.yaml";
    line << plugins_.words();
    line << start_.words();
    if (options_.online) line << " --online";
    if (rate_ != "scan") line << " --rate " << rate_;
    if (!stamps_file_.empty()) line << " --stamps " << stamps_file_;
    if (options_.octomap) line << " --octomap";
    if (options_.from_s > 0) line << " --from " << options_.from_s;
    if (options_.to_s) line << " --to " << *options_.to_s;
    return line.str();
  }

  CLI::App* replay_ = nullptr;
  ReplayOptions options_;
  ConfigOptions config_;
  PluginOption plugins_;
  StartOptions start_;
  std::string rate_ = "scan", stamps_file_;
  std::vector<TimeNs> stamps_;
  std::string output_ = "paloc_result";
  double to_s_ = 0;
  int threads_ = 0;
  bool overwrite_ = false, json_ = false;
  bool no_side_file_ = false;
};

}  // namespace

std::unique_ptr<Command> makeReplayCommand() { return std::make_unique<ReplayCommand>(); }

}  // namespace paloc

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "bench_commands.h"
#include "paloc/core/errors.h"
#include "paloc/tools/bench_frontends.h"
#include "paloc/tools/config_options.h"
#include "paloc/tools/plugin_option.h"
#include "paloc/tools/progress_line.h"

namespace paloc {
namespace {

constexpr const char* kExample = R"(Example:
  paloc bench frontends --frontend fast_lio --sensor vlp-16 --duration 120
  paloc bench frontends --scene stairwell --seeds 20 --duration 40 --json
  paloc bench frontends --log recording.rawlog --truth truth.tum

Runs a front-end alone, without a map, on simulated recordings (one for each seed) or on a given
one, and compares its odometry with the truth. The front-end knows the noise of the simulated IMU,
as that of a real one from its data sheet. Drift: error of the position in percent of the way, at
the end with the first poses laid on each other, and of the motions over 10 m of way (one begins
every metre). RPE: RMSE of the motion from frame to frame, and over a second. NEES: of the motion
from frame to frame in its covariance, per degree of freedom; 1 is right. Times are of the
processor, so that others on the machine do not count.
Exit codes: 0 done, 1 a run diverged (more than a tenth of its way, or of any 10 m, is wrong) or has
a covariance that is none, 2 wrong usage, 3 an input cannot be read.)";

class BenchFrontendsCommand : public Command {
 public:
  void registerOn(CLI::App& bench) override {
    app_ = bench.add_subcommand("frontends", "Drift, covariance and speed of an odometry");
    app_->add_option("--frontend", settings_.frontend, "which")->capture_default_str();
    plugins_.registerOn(*app_);
    app_->add_option("--scene", settings_.scene, "where, as of paloc synth")->capture_default_str();
    app_->add_option("--sensor", settings_.sensor, "LiDAR, as of paloc synth")
        ->capture_default_str();
    app_->add_option("--duration", settings_.duration_s, "length of a recording (s)")
        ->check(CLI::Range(1.0, 3600.0))
        ->capture_default_str();
    app_->add_option("--seeds", settings_.seeds, "recordings")
        ->check(CLI::Range(1, 100000))
        ->capture_default_str();
    app_->add_option("--first-seed", settings_.first_seed, "of them")->capture_default_str();
    app_->add_flag("--configured-imu", settings_.configured_imu,
                   "the IMU's noise from the settings, not that of the simulated IMU");
    auto* log = app_->add_option("--log", log_, "a recording (rawlog) instead");
    auto* truth = app_->add_option("--truth", truth_, "its truth: poses of the body (TUM)");
    log->needs(truth);
    truth->needs(log);
    app_->add_flag("--json", json_, "one JSON object on standard output (m, rad, ms)");
    config_.registerOn(*app_);
    app_->footer(kExample);
  }

  bool called() const override { return app_->parsed(); }

  ExitCode run() override {
    plugins_.load();
    settings_.log = log_;
    settings_.truth = truth_;
    ProgressLine line;
    const BenchFrontendsResult result =
        benchFrontends(settings_, config_.load(), [&](double share) {
          char text[40];
          std::snprintf(text, sizeof text, "%3.0f %%", 100 * share);
          line.show(text);
        });
    line.finish();
    printResult(json_ ? jsonOf(result).dump(2) + '\n' : tableOf(result));
    const bool sound = std::all_of(
        result.runs.begin(), result.runs.end(),
        [](const FrontendRun& run) { return !run.diverged() && run.figures.unusable == 0; });
    return sound ? ExitCode::kGood : ExitCode::kDegraded;
  }

 private:
  CLI::App* app_ = nullptr;
  BenchFrontendsSettings settings_;
  ConfigOptions config_;
  PluginOption plugins_;
  std::string log_, truth_;
  bool json_ = false;
};

}  // namespace

std::unique_ptr<Command> makeBenchFrontendsCommand() {
  return std::make_unique<BenchFrontendsCommand>();
}

}  // namespace paloc

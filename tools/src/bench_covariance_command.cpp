#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "bench_commands.h"
#include "paloc/tools/bench_covariance.h"
#include "paloc/tools/config_options.h"
#include "paloc/tools/progress_line.h"

namespace paloc {
namespace {

constexpr const char* kExample = R"(Example:
  paloc bench covariance --seeds 50
  paloc bench covariance --places building --sensor os1-128 --map-bias 0.003 --json

Each seed is a recording and a map of its own, simulated, replayed and compared with the truth:
NEES per degree of freedom is 1 where covariances are right. The bias of the map's surfaces is
also what is configured (matcher.plane_bias_m), and so is the noise of the IMU (imu.*). A place is
a scene of paloc synth, after a + with what is changed there since the survey.
Exit codes: 0 done, 1 a seed gave no trajectory or an unusable covariance, 2 wrong usage.)";

class BenchCovarianceCommand : public Command {
 public:
  void registerOn(CLI::App& bench) override {
    app_ = bench.add_subcommand("covariance", "Whether covariances hold over whole trajectories");
    app_->add_option("--places", settings_.places, "where")->delimiter(',')->capture_default_str();
    app_->add_option("--sensor", settings_.sensor, "LiDAR, as of paloc synth")
        ->capture_default_str();
    app_->add_option("--frontend", settings_.frontend, "odometry front-end, as of paloc replay")
        ->capture_default_str();
    app_->add_option("--seeds", settings_.seeds, "recordings of each place")
        ->check(CLI::Range(1, 100000))
        ->capture_default_str();
    app_->add_option("--first-seed", settings_.first_seed, "of them")->capture_default_str();
    app_->add_option("--duration", settings_.duration_s, "length of a recording (s)")
        ->check(CLI::Range(1.0, 3600.0))
        ->capture_default_str();
    app_->add_option("--map-bias", settings_.map_bias_m,
                     "shift of whole surfaces in the map (m, one sigma)")
        ->check(CLI::Range(0.0, 0.1))
        ->capture_default_str();
    app_->add_flag("--configured-imu", settings_.configured_imu,
                   "the IMU's noise from the settings, not that of the simulated IMU");
    app_->add_flag("--json", json_, "one JSON object on standard output (m, rad)");
    config_.registerOn(*app_);
    app_->footer(kExample);
  }

  bool called() const override { return app_->parsed(); }

  ExitCode run() override {
    ProgressLine line;
    const BenchCovarianceResult result =
        benchCovariance(settings_, config_.load(), [&](double share) {
          char text[40];
          std::snprintf(text, sizeof text, "%3.0f %%", 100 * share);
          line.show(text);
        });
    line.finish();
    printResult(json_ ? jsonOf(result).dump(2) + '\n' : tableOf(result));
    const bool sound = std::all_of(
        result.places.begin(), result.places.end(),
        [](const auto& place) { return place.second.failed + place.second.unusable == 0; });
    return sound ? ExitCode::kGood : ExitCode::kDegraded;
  }

 private:
  CLI::App* app_ = nullptr;
  BenchCovarianceSettings settings_;
  ConfigOptions config_;
  bool json_ = false;
};

}  // namespace

std::unique_ptr<Command> makeBenchCovarianceCommand() {
  return std::make_unique<BenchCovarianceCommand>();
}

}  // namespace paloc

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "bench_commands.h"
#include "paloc/tools/bench_corridor.h"
#include "paloc/tools/config_options.h"
#include "paloc/tools/progress_line.h"
#include "paloc/tools/result_folder.h"

namespace paloc {
namespace {

constexpr const char* kExample = R"(Example:
  paloc bench corridor --angle 45
  paloc bench corridor --sensor vlp-16 --length 20 --json

A walk from a room through a bare corridor, along which the map fixes nothing, into another room,
with an odometry whose steps are half a percent too long; the same scans also without degeneracy
handling. Along: position along the corridor; across: the two other axes together; sigmas: the
largest error along the corridor in its standard deviations, at any pose. Online: each pose as it
was when its scan came.
Exit codes: 0 all targets met, 1 one is missed, 2 wrong usage.)";

class BenchCorridorCommand : public Command {
 public:
  void registerOn(CLI::App& bench) override {
    app_ = bench.add_subcommand("corridor", "Through a corridor with a free axis, and out of it");
    app_->add_option("--length", settings_.free_m, "way over which the axis is free (m)")
        ->check(CLI::Range(5.0, 1000.0))
        ->capture_default_str();
    app_->add_option("--angle", settings_.angle_deg, "of the corridor in the map (degrees)")
        ->check(CLI::Range(-360.0, 360.0))
        ->capture_default_str();
    app_->add_option("--sensor", settings_.sensor, "LiDAR, as of paloc synth")
        ->capture_default_str();
    app_->add_option("--odometry-scale", settings_.odometry_scale,
                     "each step of the odometry is so many times too long")
        ->check(CLI::Range(0.5, 2.0))
        ->capture_default_str();
    app_->add_option("--seed", settings_.seed, "of all random numbers")->capture_default_str();
    app_->add_option("--list", list_file_, "write a row per pose, online and batch, to this CSV");
    app_->add_flag("--json", json_, "one JSON object on standard output (m, standard deviations)");
    config_.registerOn(*app_);
    app_->footer(kExample);
  }

  bool called() const override { return app_->parsed(); }

  ExitCode run() override {
    ProgressLine line;
    const BenchCorridorResult result = benchCorridor(settings_, config_.load(), [&](double share) {
      char text[40];
      std::snprintf(text, sizeof text, "%3.0f %%", 100 * share);
      line.show(text);
    });
    line.finish();
    if (!list_file_.empty()) writeTextFile(list_file_, posesCsv(result));
    printResult(json_ ? jsonOf(result).dump(2) + '\n' : tableOf(result));
    const auto targets = result.targets();
    const bool met = std::all_of(targets.begin(), targets.end(),
                                 [](const CorridorTarget& target) { return target.met(); });
    return met ? ExitCode::kGood : ExitCode::kDegraded;
  }

 private:
  CLI::App* app_ = nullptr;
  ConfigOptions config_;
  BenchCorridorSettings settings_;
  std::string list_file_;
  bool json_ = false;
};

}  // namespace

std::unique_ptr<Command> makeBenchCorridorCommand() {
  return std::make_unique<BenchCorridorCommand>();
}

}  // namespace paloc

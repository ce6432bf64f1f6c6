#include <CLI/CLI.hpp>
#include <map>
#include <nlohmann/json.hpp>

#include "bench_commands.h"
#include "paloc/core/errors.h"
#include "paloc/tools/bench_smoother.h"

namespace paloc {
namespace {

constexpr const char* kSmootherExample = R"(Example:
  paloc bench smoother --problem corridor.problem
  paloc bench smoother --problem corridor.problem --lag 20 --mode online --tum online.tum --json

An update is one node: preintegration, its factors, linearization, solution and the covariance of
the newest state. Without --mode, the problem is smoothed online and then as a batch; --tum then
gets the batch's trajectory. `--mode batch` does the same: it starts from the online estimate.
Exit codes: 0 done, 1 the batch did not converge or repairs were needed, 2 wrong usage, 3 the
problem cannot be read.)";

const std::map<std::string, BenchSmootherSettings::Mode> kModes{
    {"online", BenchSmootherSettings::Mode::kOnline},
    {"batch", BenchSmootherSettings::Mode::kBatch},
    {"both", BenchSmootherSettings::Mode::kBoth}};

class BenchSmootherCommand : public Command {
 public:
  void registerOn(CLI::App& bench) override {
    app_ = bench.add_subcommand("smoother", "The estimator alone, on a smoother problem");
    app_->add_option("--problem", problem_, "file with the measurements and the truth")->required();
    app_->add_option("--lag", settings_.lag_s, "length of the window (s)")->capture_default_str();
    app_->add_option("--mode", mode_, "what to run")
        ->check(CLI::IsMember(kModes))
        ->capture_default_str();
    app_->add_option("--tum", tum_, "write the trajectory to this file (TUM)");
    app_->add_flag("--json", json_, "one JSON object on standard output (m, rad, ms)");
    app_->footer(kSmootherExample);
  }

  bool called() const override { return app_->parsed(); }

  ExitCode run() override {
    settings_.mode = kModes.at(mode_);
    if (!(settings_.lag_s > 0 && settings_.lag_s <= 1e6)) {
      throw UsageError("--lag must be a positive time in seconds, at most 1e6");
    }
    const SmootherProblem problem = readSmootherProblem(problem_);
    const BenchSmootherResult result = benchSmoother(problem, settings_);
    if (!tum_.empty()) writeTum(tum_, result.trajectory);
    printResult(json_ ? jsonOf(result).dump(2) + '\n' : tableOf(result));
    const bool degraded =
        result.repairs.total() > 0 || (result.batch.has_value() && !result.batch_converged);
    return degraded ? ExitCode::kDegraded : ExitCode::kGood;
  }

 private:
  CLI::App* app_ = nullptr;
  BenchSmootherSettings settings_;
  std::string problem_, tum_;
  std::string mode_ = "both";
  bool json_ = false;
};

}  // namespace

std::unique_ptr<Command> makeBenchSmootherCommand() {
  return std::make_unique<BenchSmootherCommand>();
}

}  // namespace paloc

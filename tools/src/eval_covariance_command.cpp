#include <CLI/CLI.hpp>
#include <iostream>
#include <nlohmann/json.hpp>

#include "eval_commands.h"
#include "paloc/core/errors.h"
#include "paloc/tools/eval_covariance.h"

namespace paloc {
namespace {

constexpr const char* kExample = R"(Example:
  paloc eval covariance truth.tum result/trajectory_cov.csv

NEES per degree of freedom: the square of an error in units of its covariance. It is 1 where the
covariance is right, and above 1 where the result is surer than it should be. Not aligned: the
covariance is that of the pose in the map.
Exit codes: 0 compared, 1 a covariance is not positive definite, 2 wrong usage, 3 a file is wrong.)";

class EvalCovarianceCommand : public Command {
 public:
  void registerOn(CLI::App& eval) override {
    app_ = eval.add_subcommand("covariance", "See whether covariances and flags hold");
    app_->add_option("REF", reference_, "reference trajectory (TUM)")->required();
    app_->add_option("EST", estimate_, "a result's trajectory_cov.csv")->required();
    app_->add_option("--max-dt", max_dt_s_, "matched poses are at most this far apart (s)")
        ->check(CLI::Range(0.0, 1e6))
        ->capture_default_str();
    app_->add_flag("--json", json_, "one JSON object on standard output (m, rad)");
    app_->footer(kExample);
  }

  bool called() const override { return app_->parsed(); }

  ExitCode run() override {
    const EvalCovarianceResult result =
        evaluateCovariance(readTum(reference_), readTrajectoryCovariance(estimate_), max_dt_s_);
    std::cout << (json_ ? jsonOf(result).dump(2) + '\n' : tableOf(result)) << std::flush;
    if (!std::cout) throw IoError("the result could not be written to standard output");
    return result.unusable > 0 ? ExitCode::kDegraded : ExitCode::kGood;
  }

 private:
  CLI::App* app_ = nullptr;
  std::string reference_, estimate_;
  double max_dt_s_ = 0.01;
  bool json_ = false;
};

}  // namespace

std::unique_ptr<Command> makeEvalCovarianceCommand() {
  return std::make_unique<EvalCovarianceCommand>();
}

}  // namespace paloc

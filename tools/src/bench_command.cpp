#include <CLI/CLI.hpp>
#include <iostream>
#include <map>
#include <nlohmann/json.hpp>

#include "paloc/core/errors.h"
#include "paloc/tools/bench_registration.h"
#include "paloc/tools/bench_smoother.h"
#include "paloc/tools/commands.h"
#include "paloc/tools/config_options.h"

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

constexpr const char* kRegistrationExample = R"(Example:
  paloc bench registration
  paloc bench registration --map-points 1000000,8000000 --points 1000,3000 --threads 2 --json
  paloc bench registration --map map.ply --scans scans --poses truth.tum

Without --map it makes a building of furnished rooms, sampled to a map of each size, and OS1-128
scans from random places in it; each scan is registered from 14 cm and 1 degree off the truth.
A match is association, solution and information; the filter is told apart.
Exit codes: 0 done, 1 a scan was refused, 2 wrong usage, 3 a file cannot be read.)";

const std::map<std::string, BenchSmootherSettings::Mode> kModes{
    {"online", BenchSmootherSettings::Mode::kOnline},
    {"batch", BenchSmootherSettings::Mode::kBatch},
    {"both", BenchSmootherSettings::Mode::kBoth}};

void print(const std::string& result) {
  std::cout << result << std::flush;
  if (!std::cout) throw IoError("the result could not be written to standard output");
}

class SmootherBench {
 public:
  void registerOn(CLI::App& bench) {
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

  bool called() const { return app_->parsed(); }

  ExitCode run() {
    settings_.mode = kModes.at(mode_);
    if (!(settings_.lag_s > 0 && settings_.lag_s <= 1e6)) {
      throw UsageError("--lag must be a positive time in seconds, at most 1e6");
    }
    const SmootherProblem problem = readSmootherProblem(problem_);
    const BenchSmootherResult result = benchSmoother(problem, settings_);
    if (!tum_.empty()) writeTum(tum_, result.trajectory);
    print(json_ ? jsonOf(result).dump(2) + '\n' : tableOf(result));
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

class RegistrationBench {
 public:
  void registerOn(CLI::App& bench) {
    app_ = bench.add_subcommand("registration", "Scans onto a prior map: speed and accuracy");
    CLI::Option* map = app_->add_option("--map", settings_.map, "this map, not a simulated one");
    CLI::Option* scans =
        app_->add_option("--scans", settings_.scans, "folder of scans, in order of their names")
            ->needs(map);
    CLI::Option* poses =
        app_->add_option("--poses", settings_.poses, "their true poses, in the same order (TUM)")
            ->needs(scans);
    scans->needs(poses);
    app_->add_option("--map-points", settings_.map_points, "sizes of the simulated map")
        ->delimiter(',')
        ->capture_default_str()
        ->check(CLI::Range(10'000, 100'000'000))
        ->excludes(map);
    app_->add_option("--points", settings_.points, "points of a scan, after the filter, at most")
        ->delimiter(',')
        ->capture_default_str()
        ->check(CLI::Range(100, 1'000'000));
    app_->add_option("--threads", settings_.threads, "numbers of threads")
        ->delimiter(',')
        ->capture_default_str()
        ->check(CLI::Range(1, 64));
    app_->add_option("--places", settings_.places, "scans")
        ->capture_default_str()
        ->check(CLI::Range(1, 100'000));
    app_->add_option("--repeat", settings_.repeat, "times; the fastest of each scan counts")
        ->capture_default_str()
        ->check(CLI::Range(1, 1000));
    app_->add_option("--seed", settings_.seed, "of all random numbers")->capture_default_str();
    app_->add_flag("--json", json_, "one JSON object on standard output (m, rad, ms, s)");
    config_.registerOn(*app_);
    app_->footer(kRegistrationExample);
  }

  bool called() const { return app_->parsed(); }

  ExitCode run() {
    const std::vector<RegistrationRun> runs = benchRegistration(settings_, config_.load());
    print(json_ ? jsonOf(runs).dump(2) + '\n' : tableOf(runs));
    for (const RegistrationRun& one : runs) {
      if (one.accepted < one.scans) return ExitCode::kDegraded;
    }
    return ExitCode::kGood;
  }

 private:
  CLI::App* app_ = nullptr;
  ConfigOptions config_;
  BenchRegistrationSettings settings_;
  bool json_ = false;
};

class BenchCommand : public Command {
 public:
  void registerOn(CLI::App& app) override {
    CLI::App* bench = app.add_subcommand("bench", "Measure speed and accuracy of a part");
    bench->require_subcommand(1);
    smoother_.registerOn(*bench);
    registration_.registerOn(*bench);
  }

  bool called() const override { return smoother_.called() || registration_.called(); }

  ExitCode run() override { return smoother_.called() ? smoother_.run() : registration_.run(); }

 private:
  SmootherBench smoother_;
  RegistrationBench registration_;
};

}  // namespace

std::unique_ptr<Command> makeBenchCommand() { return std::make_unique<BenchCommand>(); }

}  // namespace paloc

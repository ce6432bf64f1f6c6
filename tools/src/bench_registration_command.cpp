#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "bench_commands.h"
#include "paloc/tools/bench_registration.h"
#include "paloc/tools/config_options.h"

namespace paloc {
namespace {

constexpr const char* kRegistrationExample = R"(Example:
  paloc bench registration
  paloc bench registration --map-points 1000000,8000000 --points 1000,3000 --threads 2 --json
  paloc bench registration --map map.ply --scans scans --poses truth.tum

Without --map it makes a building of furnished rooms, sampled to a map of each size, and OS1-128
scans from random places in it; each scan is registered from 14 cm and 1 degree off the truth.
A match is all but the filter; information and spectrum run side by side on two threads.
Exit codes: 0 done, 1 a scan was refused, 2 wrong usage, 3 a file cannot be read.)";

class BenchRegistrationCommand : public Command {
 public:
  void registerOn(CLI::App& bench) override {
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

  bool called() const override { return app_->parsed(); }

  ExitCode run() override {
    const std::vector<RegistrationRun> runs = benchRegistration(settings_, config_.load());
    printResult(json_ ? jsonOf(runs).dump(2) + '\n' : tableOf(runs));
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

}  // namespace

std::unique_ptr<Command> makeBenchRegistrationCommand() {
  return std::make_unique<BenchRegistrationCommand>();
}

}  // namespace paloc

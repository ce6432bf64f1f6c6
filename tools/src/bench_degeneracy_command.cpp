#include "bench_commands.h"

#include <CLI/CLI.hpp>
#include <iostream>
#include <nlohmann/json.hpp>

#include "paloc/core/errors.h"
#include "paloc/tools/bench_degeneracy.h"
#include "paloc/tools/progress_line.h"

namespace paloc {
namespace {

constexpr const char* kExample = R"(Example:
  paloc bench degeneracy
  paloc bench degeneracy --scenes corridor-45,tunnel --sensors vlp-16 --poses 20 --json

Scans are simulated at random poses of each scene and matched to a survey of it. A direction is
labelled by the exact geometry: degenerate where white range noise alone would leave it more than
5 cm or 0.5 degrees uncertain, full where it leaves less than a fifth of that; what lies between
does not count. Found is a degenerate direction that is classed none; a full one that is classed
partial or none is a false alarm. The time is that of classing the directions.)";

class BenchDegeneracyCommand : public Command {
 public:
  void registerOn(CLI::App& bench) override {
    command_ = bench.add_subcommand("degeneracy", "Directions that a map leaves open, by scene");
    command_->add_option("--scenes", settings_.scenes, "names, by commas; all if left out")
        ->delimiter(',');
    command_->add_option("--sensors", settings_.sensors, "names, by commas; all if left out")
        ->delimiter(',');
    command_->add_option("--poses", settings_.poses, "of each scene and sensor")
        ->check(CLI::Range(1, 100000))
        ->capture_default_str();
    command_->add_option("--seed", settings_.seed, "of all random numbers")->capture_default_str();
    command_->add_option("--list", settings_.list_file, "write a row per direction to this CSV");
    command_->add_flag("--json", json_, "one JSON object on standard output");
    command_->footer(kExample);
  }

  bool called() const override { return command_->parsed(); }

  ExitCode run() override {
    ProgressLine line;
    const auto rows =
        benchDegeneracy(settings_, [&](const std::string& what) { line.show(what, true); });
    line.finish();
    std::cout << (json_ ? jsonOf(rows).dump(2) + '\n' : tableOf(rows)) << std::flush;
    if (!std::cout) throw IoError("the result could not be written to standard output");
    return ExitCode::kGood;
  }

 private:
  CLI::App* command_ = nullptr;
  BenchDegeneracySettings settings_;
  bool json_ = false;
};

}  // namespace

std::unique_ptr<Command> makeBenchDegeneracyCommand() {
  return std::make_unique<BenchDegeneracyCommand>();
}

}  // namespace paloc

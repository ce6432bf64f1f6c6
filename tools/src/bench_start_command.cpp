#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "bench_commands.h"
#include "paloc/tools/bench_start.h"
#include "paloc/tools/config_options.h"
#include "paloc/tools/progress_line.h"

namespace paloc {
namespace {

constexpr const char* kExample = R"(Example:
  paloc bench start
  paloc bench start --places 20 --partial 0 --wrong 0 --storeys 0 --sensor vlp-16 --json

Scans are simulated at random poses of a scene and looked for in a survey of it: from a pose that is
off by 1 m and 15 degrees, or 3 m and 45 degrees, from the position alone, and from nothing. Then
the same in maps cut off beyond a plane that passes within a metre. Then scans of every scene are
looked for in the map of every other, and scans of the building in those of its other storeys (the
same walls, other furniture), where none is to be found. Found is what is within 10 cm and 1 degree
of the truth; false, what was accepted and is not.)";

class BenchStartCommand : public Command {
 public:
  void registerOn(CLI::App& bench) override {
    command_ = bench.add_subcommand("start", "Finding the first pose in the map, and refusing to");
    command_->add_option("--scene", settings_.scene, "where starts are to be found")
        ->capture_default_str();
    command_->add_option("--sensor", settings_.sensor, "of the scans")->capture_default_str();
    command_->add_option("--places", settings_.places, "random poses in it")
        ->check(CLI::Range(0, 100000))
        ->capture_default_str();
    command_
        ->add_option("--partial", settings_.partial,
                     "random poses in maps that lack half of what is seen from there")
        ->check(CLI::Range(0, 100000))
        ->capture_default_str();
    command_->add_option("--wrong", settings_.wrong, "starts in maps of other places")
        ->check(CLI::Range(0, 1000000))
        ->capture_default_str();
    command_
        ->add_option("--storeys", settings_.storeys,
                     "starts in maps of other storeys of the building")
        ->check(CLI::Range(0, 1000000))
        ->capture_default_str();
    command_->add_option("--seed", settings_.seed, "of all random numbers")->capture_default_str();
    command_->add_option("--list", settings_.list_file, "write a row per start to this CSV");
    command_->add_flag("--json", json_, "one JSON object on standard output");
    config_.registerOn(*command_);
    command_->footer(kExample);
  }

  bool called() const override { return command_->parsed(); }

  ExitCode run() override {
    const Config config = config_.load();
    settings_.map = config.map;
    settings_.matcher = config.matcher;
    ProgressLine line;
    const auto rows = benchStart(settings_, [&](const std::string& what, double share) {
      line.show(what + "  " + std::to_string(static_cast<int>(100 * share)) + " %");
    });
    line.finish();
    printResult(json_ ? jsonOf(rows).dump(2) + '\n' : tableOf(rows));
    return ExitCode::kGood;
  }

 private:
  CLI::App* command_ = nullptr;
  BenchStartSettings settings_;
  ConfigOptions config_;
  bool json_ = false;
};

}  // namespace

std::unique_ptr<Command> makeBenchStartCommand() { return std::make_unique<BenchStartCommand>(); }

}  // namespace paloc

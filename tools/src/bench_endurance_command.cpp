#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "bench_commands.h"
#include "paloc/tools/bench_endurance.h"

namespace paloc {
namespace {

constexpr const char* kExample = R"(Example:
  paloc bench endurance --updates 1000000

A simulated drive that nobody stores, with gaps, late, too late and broken measurements; 0.1 s an
update. Time, memory, error and consistency of each tenth of the run: none of them may grow.)";

class BenchEnduranceCommand : public Command {
 public:
  void registerOn(CLI::App& bench) override {
    app_ = bench.add_subcommand("endurance", "The fixed-lag smoother over very many updates");
    app_->add_option("--updates", settings_.updates, "number of nodes")
        ->check(CLI::Range(std::size_t{10}, std::size_t{1'000'000'000}))
        ->capture_default_str();
    app_->add_option("--lag", settings_.lag_s, "length of the window (s)")
        ->check(CLI::Range(0.2, 50.0))
        ->capture_default_str();
    app_->add_option("--seed", settings_.seed, "of the drive")->capture_default_str();
    app_->add_flag("--json", json_, "one JSON object on standard output (m, ms, s, MB)");
    app_->footer(kExample);
  }

  bool called() const override { return app_->parsed(); }

  ExitCode run() override {
    const BenchEnduranceResult result = benchEndurance(settings_);
    printResult(json_ ? jsonOf(result).dump(2) + '\n' : tableOf(result));
    return ExitCode::kGood;
  }

 private:
  CLI::App* app_ = nullptr;
  BenchEnduranceSettings settings_;
  bool json_ = false;
};

}  // namespace

std::unique_ptr<Command> makeBenchEnduranceCommand() {
  return std::make_unique<BenchEnduranceCommand>();
}

}  // namespace paloc

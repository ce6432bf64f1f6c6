#include <CLI/CLI.hpp>
#include <algorithm>
#include <iostream>
#include <vector>

#include "bench_commands.h"
#include "paloc/core/errors.h"
#include "paloc/tools/commands.h"

namespace paloc {
namespace {

class BenchCommand : public Command {
 public:
  BenchCommand() {
    commands_.push_back(makeBenchSmootherCommand());
    commands_.push_back(makeBenchEnduranceCommand());
    commands_.push_back(makeBenchRegistrationCommand());
    commands_.push_back(makeBenchDegeneracyCommand());
  }

  void registerOn(CLI::App& app) override {
    CLI::App* bench = app.add_subcommand("bench", "Measure speed and accuracy of a part");
    bench->require_subcommand(1);
    for (const auto& command : commands_) command->registerOn(*bench);
  }

  bool called() const override { return find() != commands_.end(); }
  ExitCode run() override { return (*find())->run(); }

 private:
  using Commands = std::vector<std::unique_ptr<Command>>;

  Commands::const_iterator find() const {
    return std::find_if(commands_.begin(), commands_.end(),
                        [](const auto& command) { return command->called(); });
  }

  Commands commands_;
};

}  // namespace

void printResult(const std::string& result) {
  std::cout << result << std::flush;
  if (!std::cout) throw IoError("the result could not be written to standard output");
}

std::unique_ptr<Command> makeBenchCommand() { return std::make_unique<BenchCommand>(); }

}  // namespace paloc

#include <CLI/CLI.hpp>
#include <algorithm>

#include "paloc/core/errors.h"
#include "paloc/tools/commands.h"
#include "paloc/tools/map_commands.h"

namespace paloc {
namespace {

/// `paloc map ...`: what can be done with a prior map alone. A further sub-command is a class of
/// its own and a line in the constructor.
class MapCommand : public Command {
 public:
  MapCommand() {
    commands_.push_back(makeMapInfoCommand());
    commands_.push_back(makeMapConvertCommand());
  }

  void registerOn(CLI::App& app) override {
    CLI::App* map = app.add_subcommand("map", "Look at a prior map, and work with it");
    map->require_subcommand(1);
    for (const auto& command : commands_) command->registerOn(*map);
  }

  bool called() const override { return findCalled() != commands_.end(); }

  ExitCode run() override {
    const auto command = findCalled();
    if (command == commands_.end()) throw UsageError("map: no sub-command was given");
    return (*command)->run();
  }

 private:
  using Commands = std::vector<std::unique_ptr<Command>>;

  Commands::const_iterator findCalled() const {
    return std::find_if(commands_.begin(), commands_.end(),
                        [](const auto& command) { return command->called(); });
  }

  Commands commands_;
};

}  // namespace

std::unique_ptr<Command> makeMapCommand() { return std::make_unique<MapCommand>(); }

}  // namespace paloc

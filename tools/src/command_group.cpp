#include "paloc/tools/command_group.h"

#include <CLI/CLI.hpp>

#include "paloc/core/errors.h"

namespace paloc {

CommandGroup::CommandGroup(std::string name, std::string description,
                           std::vector<std::unique_ptr<Command>> commands)
    : name_(std::move(name)),
      description_(std::move(description)),
      commands_(std::move(commands)) {}

void CommandGroup::registerOn(CLI::App& app) {
  CLI::App* group = app.add_subcommand(name_, description_);
  group->require_subcommand(1);
  for (const auto& command : commands_) command->registerOn(*group);
}

ExitCode CommandGroup::run() {
  Command* command = find();
  if (!command) throw UsageError(name_ + ": no sub-command was given");
  return command->run();
}

Command* CommandGroup::find() const {
  for (const auto& command : commands_) {
    if (command->called()) return command.get();
  }
  return nullptr;
}

}  // namespace paloc

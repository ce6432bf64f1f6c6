#include "paloc/tools/command_group.h"
#include "paloc/tools/commands.h"
#include "paloc/tools/map_commands.h"

namespace paloc {

std::unique_ptr<Command> makeMapCommand() {
  std::vector<std::unique_ptr<Command>> commands;
  commands.push_back(makeMapInfoCommand());
  commands.push_back(makeMapConvertCommand());
  commands.push_back(makeMapLocateCommand());
  return std::make_unique<CommandGroup>("map", "Look at a prior map, and work with it",
                                        std::move(commands));
}

}  // namespace paloc

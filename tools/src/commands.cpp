#include "paloc/tools/commands.h"

namespace paloc {

std::vector<std::unique_ptr<Command>> allCommands() {
  std::vector<std::unique_ptr<Command>> commands;
  commands.push_back(makeEvalCommand());
  commands.push_back(makeBenchCommand());
  commands.push_back(makeConfigCommand());
  commands.push_back(makeReplayCommand());
  commands.push_back(makeSynthCommand());
  commands.push_back(makeImportCommand());
  commands.push_back(makeExportCommand());
  commands.push_back(makeInfoCommand());
  commands.push_back(makeCheckCommand());
  commands.push_back(makeMapCommand());
  return commands;
}

}  // namespace paloc

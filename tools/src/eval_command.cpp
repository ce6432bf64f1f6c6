#include "eval_commands.h"
#include "paloc/tools/command_group.h"
#include "paloc/tools/commands.h"

namespace paloc {

std::unique_ptr<Command> makeEvalCommand() {
  std::vector<std::unique_ptr<Command>> commands;
  commands.push_back(makeEvalTrajCommand());
  commands.push_back(makeEvalCovarianceCommand());
  commands.push_back(makeEvalChangesCommand());
  return std::make_unique<CommandGroup>("eval", "Compare a result with a reference",
                                        std::move(commands));
}

}  // namespace paloc

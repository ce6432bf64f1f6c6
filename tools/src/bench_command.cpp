#include "bench_commands.h"
#include "paloc/tools/command_group.h"
#include "paloc/tools/commands.h"

namespace paloc {

std::unique_ptr<Command> makeBenchCommand() {
  std::vector<std::unique_ptr<Command>> commands;
  commands.push_back(makeBenchSmootherCommand());
  commands.push_back(makeBenchEnduranceCommand());
  commands.push_back(makeBenchRegistrationCommand());
  commands.push_back(makeBenchDegeneracyCommand());
  commands.push_back(makeBenchCovarianceCommand());
  commands.push_back(makeBenchStartCommand());
  commands.push_back(makeBenchCorridorCommand());
  commands.push_back(makeBenchFrontendsCommand());
  return std::make_unique<CommandGroup>("bench", "Measure speed and accuracy of a part",
                                        std::move(commands));
}

}  // namespace paloc

#pragma once

#include <memory>

#include "paloc/tools/command.h"
#include "paloc/tools/print_result.h"

namespace paloc {

// They register themselves below `bench`.
std::unique_ptr<Command> makeBenchCorridorCommand();
std::unique_ptr<Command> makeBenchCovarianceCommand();
std::unique_ptr<Command> makeBenchDegeneracyCommand();
std::unique_ptr<Command> makeBenchEnduranceCommand();
std::unique_ptr<Command> makeBenchFrontendsCommand();
std::unique_ptr<Command> makeBenchRegistrationCommand();
std::unique_ptr<Command> makeBenchSmootherCommand();
std::unique_ptr<Command> makeBenchStartCommand();

}  // namespace paloc

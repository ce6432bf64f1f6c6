#pragma once

#include <memory>
#include <string>

#include "paloc/tools/command.h"

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

/// Prints to standard output; throws IoError where that fails.
void printResult(const std::string& result);

}  // namespace paloc

#pragma once

#include <memory>

#include "paloc/tools/command.h"

namespace paloc {

// They register themselves below `eval`.
std::unique_ptr<Command> makeEvalChangesCommand();
std::unique_ptr<Command> makeEvalCovarianceCommand();
std::unique_ptr<Command> makeEvalTrajCommand();

}  // namespace paloc

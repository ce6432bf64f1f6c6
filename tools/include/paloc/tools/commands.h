#pragma once

#include <memory>

#include "paloc/tools/command.h"

namespace paloc {

// One maker a sub-command; the class itself stays in its source file.
std::unique_ptr<Command> makeBenchCommand();
std::unique_ptr<Command> makeCheckCommand();
std::unique_ptr<Command> makeConfigCommand();
std::unique_ptr<Command> makeEvalCommand();
std::unique_ptr<Command> makeExportCommand();
std::unique_ptr<Command> makeImportCommand();
std::unique_ptr<Command> makeInfoCommand();
std::unique_ptr<Command> makeMapCommand();
std::unique_ptr<Command> makeReplayCommand();
std::unique_ptr<Command> makeSynthCommand();

}  // namespace paloc

#pragma once

#include <memory>

#include "paloc/tools/command.h"

namespace paloc {

// One maker a sub-command of `paloc map`; the class itself stays in its source file.
std::unique_ptr<Command> makeMapConvertCommand();
std::unique_ptr<Command> makeMapInfoCommand();
std::unique_ptr<Command> makeMapLocateCommand();

}  // namespace paloc

#include <CLI/CLI.hpp>
#include <exception>
#include <iostream>
#include <new>

#include "paloc/core/errors.h"
#include "paloc/tools/command.h"

namespace {

int fail(paloc::ExitCode code, const std::string& sentence) {
  std::cerr << "paloc: " << sentence << '\n';
  return static_cast<int>(code);
}

int runCalled(const std::vector<std::unique_ptr<paloc::Command>>& commands) {
  for (const auto& command : commands) {
    if (command->called()) return static_cast<int>(command->run());
  }
  return static_cast<int>(paloc::ExitCode::kUsage);
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{"paloc: ground-truth trajectories from a LiDAR-inertial recording and a prior map"};
  app.set_version_flag("--version", "paloc " PALOC_VERSION);
  app.require_subcommand(1);
  const auto commands = paloc::allCommands();
  for (const auto& command : commands) command->registerOn(app);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& e) {
    const int code = app.exit(e);
    return code == 0 ? 0 : static_cast<int>(paloc::ExitCode::kUsage);
  }
  try {
    return runCalled(commands);
  } catch (const paloc::UsageError& e) {
    return fail(paloc::ExitCode::kUsage, e.what());
  } catch (const paloc::ConfigError& e) {
    return fail(paloc::ExitCode::kUsage, e.what());
  } catch (const paloc::IoError& e) {
    return fail(paloc::ExitCode::kInput, e.what());
  } catch (const std::bad_alloc&) {
    return fail(paloc::ExitCode::kInternal, "out of memory");
  } catch (const std::exception& e) {
    return fail(paloc::ExitCode::kInternal, std::string("internal error: ") + e.what());
  }
}

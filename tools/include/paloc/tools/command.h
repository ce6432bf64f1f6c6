#pragma once

#include <memory>
#include <vector>

namespace CLI {
class App;
}

namespace paloc {

/// Exit codes of the program: they tell the truth about what came out.
enum class ExitCode : int {
  kGood = 0,
  kDegraded = 1,  ///< finished, but part of the result is flagged
  kUsage = 2,
  kInput = 3,
  kNoLocalization = 4,
  kInternal = 5,
};

/// A sub-command of the program. Registered with CLI11 at start-up, run if it was called for.
class Command {
 public:
  virtual ~Command() = default;
  /// Adds itself, its options and its example (in the help's footer) below `app`.
  virtual void registerOn(CLI::App& app) = 0;
  /// True after parsing if the user called this one.
  virtual bool called() const = 0;
  /// Does the work. Throws UsageError, ConfigError or IoError for what is wrong with the input.
  virtual ExitCode run() = 0;
};

/// All sub-commands, in the order of the help.
std::vector<std::unique_ptr<Command>> allCommands();

}  // namespace paloc

#pragma once

#include <string>
#include <vector>

namespace paloc::test {

/// What a program left behind.
struct ProgramRun {
  int exit_code = -1;  ///< -1 if a signal ended it
  int signal = 0;      ///< which one, or 0
  std::string out;     ///< standard output
  std::string err;     ///< standard error
};

struct ProgramOptions {
  std::string folder;        ///< to run in; empty: the test's own
  std::string interrupt_at;  ///< send Ctrl-C (SIGINT) once standard error holds this; empty: never
  int timeout_s = 120;       ///< then it is killed, which shows as signal 9
};

/// Runs a program with arguments (no shell in between) and waits for it.
ProgramRun runProgram(const std::string& program, const std::vector<std::string>& arguments,
                      const ProgramOptions& options = {});

/// Runs build/bin/paloc.
ProgramRun runPaloc(const std::vector<std::string>& arguments, const ProgramOptions& options = {});

}  // namespace paloc::test

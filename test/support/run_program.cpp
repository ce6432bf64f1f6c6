#include "run_program.h"

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <stdexcept>
#include <thread>

#include "temp_dir.h"

namespace paloc::test {
namespace {

void redirect(const std::string& file, int descriptor) {
  const int opened = open(file.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
  if (opened < 0 || dup2(opened, descriptor) < 0) _exit(126);
}

[[noreturn]] void becomeProgram(const std::string& program,
                                const std::vector<std::string>& arguments,
                                const std::string& folder, const TempDir& output) {
  redirect(output / "out", STDOUT_FILENO);
  redirect(output / "err", STDERR_FILENO);
  const int nothing = open("/dev/null", O_RDONLY);
  if (nothing >= 0) dup2(nothing, STDIN_FILENO);
  if (!folder.empty() && chdir(folder.c_str()) != 0) _exit(126);
  std::vector<char*> argv;
  argv.push_back(const_cast<char*>(program.c_str()));
  for (const auto& argument : arguments) argv.push_back(const_cast<char*>(argument.c_str()));
  argv.push_back(nullptr);
  execv(program.c_str(), argv.data());
  _exit(127);
}

int waitFor(pid_t child, const ProgramOptions& options, const TempDir& output) {
  using Clock = std::chrono::steady_clock;
  const auto start = Clock::now();
  bool interrupted = options.interrupt_at.empty();
  int status = 0;
  while (waitpid(child, &status, WNOHANG) == 0) {
    const auto elapsed = Clock::now() - start;
    if (!interrupted && std::filesystem::exists(output / "err") &&
        readFile(output / "err").find(options.interrupt_at) != std::string::npos) {
      kill(child, SIGINT);
      interrupted = true;
    }
    if (elapsed >= std::chrono::seconds(options.timeout_s)) kill(child, SIGKILL);
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  return status;
}

}  // namespace

ProgramRun runProgram(const std::string& program, const std::vector<std::string>& arguments,
                      const ProgramOptions& options) {
  // Files instead of pipes: a program that prints much can never block on its reader.
  const TempDir output;
  const pid_t child = fork();
  if (child < 0) throw std::runtime_error("fork failed");
  if (child == 0) becomeProgram(program, arguments, options.folder, output);
  const int status = waitFor(child, options, output);
  ProgramRun run;
  if (WIFEXITED(status)) run.exit_code = WEXITSTATUS(status);
  if (WIFSIGNALED(status)) run.signal = WTERMSIG(status);
  run.out = readFile(output / "out");
  run.err = readFile(output / "err");
  return run;
}

ProgramRun runPaloc(const std::vector<std::string>& arguments, const ProgramOptions& options) {
  return runProgram(PALOC_PROGRAM, arguments, options);
}

}  // namespace paloc::test

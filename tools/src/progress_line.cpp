#include "paloc/tools/progress_line.h"

#include <unistd.h>

#include <iostream>

namespace paloc {

ProgressLine::ProgressLine()
    : terminal_(isatty(STDERR_FILENO) != 0), last_(std::chrono::steady_clock::now()) {}

void ProgressLine::show(const std::string& text, bool at_once) {
  const auto now = std::chrono::steady_clock::now();
  const auto pause = terminal_ ? std::chrono::milliseconds(100) : std::chrono::milliseconds(10'000);
  if (now - last_ < pause && !(at_once && terminal_)) return;
  last_ = now;
  open_ = terminal_;
  std::cerr << (terminal_ ? "\r\033[K" : "") << text << (terminal_ ? "" : "\n") << std::flush;
}

void ProgressLine::say(const std::string& text) {
  std::cerr << (open_ ? "\r\033[K" : "") << text << '\n' << std::flush;
  open_ = false;
}

void ProgressLine::finish() {
  if (open_) std::cerr << '\n';
  open_ = false;
}

}  // namespace paloc

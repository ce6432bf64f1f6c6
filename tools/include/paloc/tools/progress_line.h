#pragma once

#include <chrono>
#include <string>

namespace paloc {

/// One line on standard error that tells how far long work is: rewritten in place on a terminal, a
/// plain line every ten seconds elsewhere.
class ProgressLine {
 public:
  ProgressLine();
  /// Shows `text`, unless it was updated a moment ago. What will stand for long, as a stage that
  /// begins, is shown `at_once` on a terminal.
  void show(const std::string& text, bool at_once = false);
  /// Shows a line that stays, above this one.
  void say(const std::string& text);
  /// Ends the line, so that other output starts on a fresh one.
  void finish();

 private:
  bool terminal_;
  bool open_ = false;
  std::chrono::steady_clock::time_point last_;
};

}  // namespace paloc

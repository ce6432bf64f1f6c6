#pragma once

#include <optional>
#include <string>

#include "paloc/core/start_guess.h"

namespace CLI {
class App;
}

namespace paloc {

/// The options that tell where a start is to be sought: --init-pose, --init-position, --init auto;
/// of these one at most.
class StartOptions {
 public:
  /// `at`: the instant that the pose belongs to, for the help ("at the first scan").
  void registerOn(CLI::App& command, const std::string& at);
  /// Besides, --init-tum.
  void registerTumOn(CLI::App& command);

  /// What was given; nothing if nothing was. Throws UsageError for what cannot be read, IoError for
  /// the TUM file.
  std::optional<StartGuess> guess() const;
  /// As the user would type it again, with a blank before it.
  std::string words() const;

 private:
  std::string pose_, position_, mode_, tum_;
};

}  // namespace paloc

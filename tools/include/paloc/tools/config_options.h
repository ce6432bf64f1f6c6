#pragma once

#include <string>
#include <vector>

#include "paloc/config/config.h"

namespace CLI {
class App;
}

namespace paloc {

/// The options --config and --set, the same for every sub-command that takes settings.
class ConfigOptions {
 public:
  void registerOn(CLI::App& command);

  /// The defaults, overlaid by the files in their order, then by the single values. A file that
  /// does not exist, but is the name of a preset ("sensors/vlp-16"), is taken from those installed
  /// with the program. Throws ConfigError.
  Config load() const;

 private:
  std::vector<std::string> files_;
  std::vector<std::string> values_;
};

}  // namespace paloc

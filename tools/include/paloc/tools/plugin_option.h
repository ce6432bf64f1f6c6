#pragma once

#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace paloc {

/// The option --plugin: shared libraries that bring front-ends.
class PluginOption {
 public:
  void registerOn(CLI::App& command);
  /// Loads them in their order. Throws what loadFrontendPlugin() throws.
  void load() const;
  /// As the user would type it again, with a space in front; else empty.
  std::string words() const;

 private:
  std::vector<std::string> files_;
};

}  // namespace paloc

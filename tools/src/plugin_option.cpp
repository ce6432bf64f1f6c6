#include "paloc/tools/plugin_option.h"

#include <CLI/CLI.hpp>

#include "paloc/frontends/frontend_plugin.h"

namespace paloc {

void PluginOption::registerOn(CLI::App& command) {
  command
      .add_option(
          "--plugin", files_,
          "a shared library with front-ends of your own, for --frontend; may be given again")
      ->allow_extra_args(false)
      ->type_name("lib.so");
}

void PluginOption::load() const {
  for (const std::string& file : files_) loadFrontendPlugin(file);
}

std::string PluginOption::words() const {
  std::string words;
  for (const std::string& file : files_) words += " --plugin " + file;
  return words;
}

}  // namespace paloc

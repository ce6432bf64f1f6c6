#include "paloc/tools/config_options.h"

#include <CLI/CLI.hpp>
#include <filesystem>

namespace paloc {
namespace {

/// share/paloc beside the program: of the install prefix, or of the build folder.
std::filesystem::path presetFolder() {
  std::error_code error;
  const auto program = std::filesystem::read_symlink("/proc/self/exe", error);
  return error ? std::filesystem::path() : program.parent_path().parent_path() / "share" / "paloc";
}

/// `name` itself if there is such a file, else the preset of that name, else `name` again, so that
/// the error names what the user wrote.
std::filesystem::path resolve(const std::string& name) {
  if (std::filesystem::exists(name)) return name;
  const auto preset = presetFolder() / "sensors" / (name + ".yaml");
  return std::filesystem::exists(preset) ? preset : std::filesystem::path(name);
}

}  // namespace

void ConfigOptions::registerOn(CLI::App& command) {
  command
      .add_option("--config", files_,
                  "YAML settings, or a sensor's name (os1-128, vlp-16, xt-32, e1r); given again, "
                  "the later one wins")
      ->allow_extra_args(false)
      ->type_name("C.yaml");
  command.add_option("--set", values_, "One setting, over those of the files; may be given again")
      ->allow_extra_args(false)
      ->type_name("key=value");
}

Config ConfigOptions::load() const {
  Config config;
  for (const std::string& file : files_) overlayConfig(config, resolve(file));
  for (const std::string& value : values_) setValue(config, value);
  checkConfig(config);
  return config;
}

}  // namespace paloc

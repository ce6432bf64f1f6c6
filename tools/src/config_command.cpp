#include <CLI/CLI.hpp>
#include <iostream>
#include <nlohmann/json.hpp>

#include "paloc/config/settings.h"
#include "paloc/tools/commands.h"
#include "paloc/tools/config_options.h"

namespace paloc {
namespace {

using Json = nlohmann::ordered_json;

Json toJson(const SettingValue& value) {
  return std::visit([](const auto& v) { return Json(v); }, value);
}

Json describeAsJson() {
  const Config defaults;
  Json keys = Json::object();
  for (const Setting& setting : allSettings()) {
    Json row = {{"type", typeName(setting)},
                {"unit", setting.unit},
                {"default", toJson(setting.get(defaults))},
                {"description", setting.sentence}};
    if (setting.min < setting.max) {
      row["min"] = setting.min;
      row["max"] = setting.max;
    }
    if (!setting.choices.empty()) row["choices"] = setting.choices;
    keys[setting.key] = std::move(row);
  }
  return {{"settings", std::move(keys)}};
}

/// `paloc config dump` and `paloc config describe`.
class ConfigCommand : public Command {
 public:
  void registerOn(CLI::App& app) override {
    CLI::App* config = app.add_subcommand("config", "Show the settings: their values and meanings");
    config->require_subcommand(1);
    config->footer("Example:\n  paloc config dump > site.yaml");

    dump_ = config->add_subcommand("dump", "Print all settings as YAML, checked");
    options_.registerOn(*dump_);
    dump_->footer(
        "Example:\n  paloc config dump --config vlp-16 --set matcher.fine_distance_m=0.2 > "
        "site.yaml");

    describe_ = config->add_subcommand("describe", "Print every key with default, range, meaning");
    describe_->add_flag("--json", json_, "Print one JSON object");
    describe_->footer("Example:\n  paloc config describe | grep -A 1 range_noise");
  }

  bool called() const override { return dump_->parsed() || describe_->parsed(); }

  ExitCode run() override {
    if (dump_->parsed()) {
      std::cout << dumpConfig(options_.load());
    } else if (json_) {
      std::cout << describeAsJson().dump(2) << '\n';
    } else {
      std::cout << describeSettings();
    }
    return ExitCode::kGood;
  }

 private:
  CLI::App* dump_ = nullptr;
  CLI::App* describe_ = nullptr;
  ConfigOptions options_;
  bool json_ = false;
};

}  // namespace

std::unique_ptr<Command> makeConfigCommand() { return std::make_unique<ConfigCommand>(); }

}  // namespace paloc

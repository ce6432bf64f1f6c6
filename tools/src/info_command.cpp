#include <mrpt/system/os.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <iostream>
#include <nlohmann/json.hpp>

#include "paloc/core/errors.h"
#include "paloc/core/text.h"
#include "paloc/tools/commands.h"
#include "paloc/tools/recording_info.h"

namespace paloc {
namespace {

constexpr const char* kExample = R"(Example:
  paloc info log.rawlog
  paloc info foreign.rawlog --plugin libtheirs.so --json

Exit codes: 0 whole, 1 damaged (what could be read is shown), 2 wrong usage, 3 nothing could be read.)";

class InfoCommand : public Command {
 public:
  void registerOn(CLI::App& app) override {
    info_ =
        app.add_subcommand("info", "What a rawlog holds: sensors, rates, gaps, points per scan");
    info_->add_option("LOG", file_, "rawlog, gzipped or not")->required();
    info_->add_option("--plugin", plugins_, "library that brings further observation classes");
    info_->add_flag("--json", json_, "one JSON object on standard output");
    info_->footer(kExample);
  }

  bool called() const override { return info_->parsed(); }

  ExitCode run() override {
    for (const auto& plugin : plugins_) loadPlugin(plugin);
    const RecordingInfo info = readRecordingInfo(file_);
    if (json_) {
      std::cout << jsonOf(info).dump(2) << '\n';
    } else {
      std::cout << tableOf(info);
    }
    std::cout.flush();
    if (!std::cout) throw IoError("the result could not be written to standard output");
    return info.damage.empty() ? ExitCode::kGood : ExitCode::kDegraded;
  }

 private:
  static void loadPlugin(const std::string& plugin) {
    std::string why;
    if (mrpt::system::loadPluginModule(plugin, why)) return;
    std::replace(why.begin(), why.end(), '\n', ' ');
    throw IoError(text("the plugin ", plugin, " cannot be loaded: ", why));
  }

  CLI::App* info_ = nullptr;
  std::string file_;
  std::vector<std::string> plugins_;
  bool json_ = false;
};

}  // namespace

std::unique_ptr<Command> makeInfoCommand() { return std::make_unique<InfoCommand>(); }

}  // namespace paloc

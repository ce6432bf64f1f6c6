#include <CLI/CLI.hpp>
#include <cstdio>
#include <iostream>
#include <nlohmann/json.hpp>

#include "paloc/core/errors.h"
#include "paloc/tools/config_options.h"
#include "paloc/tools/map_commands.h"
#include "paloc/tools/map_info.h"
#include "paloc/tools/progress_line.h"

namespace paloc {
namespace {

constexpr const char* kExample = R"(Example:
  paloc map info survey.ply
  paloc map info survey.ply --set map.voxel_m=0.1 --json

Exit codes: 0 it can serve as a prior map, 2 wrong usage, 3 it cannot (the sentence says why).)";

class MapInfoCommand : public Command {
 public:
  void registerOn(CLI::App& app) override {
    info_ = app.add_subcommand("info", "What a map holds, and what it is worth as a prior map");
    info_->add_option("MAP", file_, "point cloud")->required();
    options_.registerOn(*info_);
    info_->add_flag("--json", json_, "one JSON object on standard output");
    info_->footer(kExample);
  }

  bool called() const override { return info_->parsed(); }

  ExitCode run() override {
    ProgressLine line;
    MapSettings settings = options_.load().map;
    settings.side_file = false;  // looking at a map leaves nothing behind
    const MapInfo info =
        readMapInfo(file_, settings, [&line](double share, const std::string& what) {
          char percent[20];
          std::snprintf(percent, sizeof percent, "%3.0f %%  ", 100 * share);
          line.show(percent + what);
        });
    line.finish();
    std::cout << (json_ ? jsonOf(info).dump(2) + '\n' : tableOf(info)) << std::flush;
    if (!std::cout) throw IoError("the result could not be written to standard output");
    return ExitCode::kGood;
  }

 private:
  CLI::App* info_ = nullptr;
  ConfigOptions options_;
  std::string file_;
  bool json_ = false;
};

}  // namespace

std::unique_ptr<Command> makeMapInfoCommand() { return std::make_unique<MapInfoCommand>(); }

}  // namespace paloc

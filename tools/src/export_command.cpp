#include <CLI/CLI.hpp>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "paloc/tools/command_group.h"
#include "paloc/tools/commands.h"
#include "paloc/tools/export_rosbag.h"
#include "paloc/tools/print_result.h"
#include "paloc/tools/progress_line.h"

namespace paloc {
namespace {

constexpr const char* kExample = R"(Example:
  paloc export rosbag log.rawlog -o log.bag

Each sensor is on a topic of its label's name, extrinsics on /tf_static from the frame "body". Points have
their times after the header's stamp: ouster as t (uint32, ns), velodyne as time (float32, s).
Exit codes: 0 all exported, 1 part of it could not be used, 2 wrong usage, 3 wrong input.)";

class ExportRosbagCommand : public Command {
 public:
  void registerOn(CLI::App& app) override {
    command_ = app.add_subcommand("rosbag", "A ROS 1 bag, for other systems to run on");
    command_->add_option("LOG", settings_.log, "rawlog, gzipped or not")->required();
    command_->add_option("-o,--output", settings_.bag, "bag to write")->required();
    command_->add_option("--layout", layout_, "fields of a point: ouster or velodyne")
        ->check(CLI::IsMember({"ouster", "velodyne"}))
        ->capture_default_str();
    command_->add_flag("--overwrite", settings_.overwrite, "replace an existing bag");
    command_->add_flag("--json", json_, "one JSON object on standard output");
    command_->footer(kExample);
  }

  bool called() const override { return command_->parsed(); }

  ExitCode run() override {
    if (layout_ == "velodyne") settings_.layout = RosCloudLayout::kVelodyne;
    const ExportSummary summary = exportRosbag(settings_, [this](double share) {
      char line[40];
      std::snprintf(line, sizeof line, "exporting %3.0f %%", 100 * share);
      progress_.show(line);
    });
    progress_.finish();
    printResult(json_ ? jsonOf(summary).dump(2) + '\n' : tableOf(summary));
    return summary.complete() ? ExitCode::kGood : ExitCode::kDegraded;
  }

 private:
  CLI::App* command_ = nullptr;
  ExportRosbagSettings settings_;
  ProgressLine progress_;
  std::string layout_ = "ouster";
  bool json_ = false;
};

}  // namespace

std::unique_ptr<Command> makeExportCommand() {
  std::vector<std::unique_ptr<Command>> commands;
  commands.push_back(std::make_unique<ExportRosbagCommand>());
  return std::make_unique<CommandGroup>("export", "Write a rawlog for other systems",
                                        std::move(commands));
}

}  // namespace paloc

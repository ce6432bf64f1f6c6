#include <CLI/CLI.hpp>
#include <cstdio>
#include <iostream>

#include "paloc/core/errors.h"
#include "paloc/tools/check_recording.h"
#include "paloc/tools/commands.h"
#include "paloc/tools/config_options.h"
#include "paloc/tools/progress_line.h"

namespace paloc {
namespace {

constexpr const char* kExample =
    R"(Looks at units, axes and mounting of the IMU, its clock against the LiDAR's, rates, gaps, stamps,
values that are not finite or clipped, and times of points; each finding tells the remedy. The
turning of up to 40 s of scans, and of a recorded odometry, is compared with the gyroscope's.

Example:
  paloc check recording.rawlog --map map.ply
  paloc check recording.rawlog --set frontend.imu_label=imu2 --json

Exit codes: 0 nothing wrong found, 1 there are findings or the file is damaged, 2 wrong usage or
configuration, 3 the recording cannot be read.)";

class CheckCommand : public Command {
 public:
  void registerOn(CLI::App& app) override {
    check_ = app.add_subcommand("check", "What is wrong with a recording, and how to mend it");
    check_->add_option("LOG", file_, "recording (MRPT rawlog)")->required();
    check_->add_option("--map", map_, "prior map, whose scale is checked, too");
    config_.registerOn(*check_);
    check_->add_flag("--json", json_, "one JSON object on standard output");
    check_->footer(kExample);
  }

  bool called() const override { return check_->parsed(); }

  ExitCode run() override {
    const Config config = config_.load();
    ProgressLine line;
    const auto progress = [&line](double share) {
      char buffer[40];
      std::snprintf(buffer, sizeof buffer, "checking: %3.0f %%", 100 * share);
      line.show(buffer);
    };
    const RecordingCheck check = checkRecording(file_, map_, config.frontend, progress);
    line.finish();
    if (json_) {
      std::cout << jsonOf(check).dump(2) << '\n';
    } else {
      std::cout << textOf(check);
    }
    std::cout.flush();
    if (!std::cout) throw IoError("the result could not be written to standard output");
    return check.clean() ? ExitCode::kGood : ExitCode::kDegraded;
  }

 private:
  CLI::App* check_ = nullptr;
  std::string file_, map_;
  ConfigOptions config_;
  bool json_ = false;
};

}  // namespace

std::unique_ptr<Command> makeCheckCommand() { return std::make_unique<CheckCommand>(); }

}  // namespace paloc

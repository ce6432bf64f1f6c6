#include <CLI/CLI.hpp>
#include <chrono>
#include <iostream>
#include <nlohmann/json.hpp>

#include "paloc/core/errors.h"
#include "paloc/map/cloud_io.h"
#include "paloc/map/scan_matcher.h"
#include "paloc/tools/config_options.h"
#include "paloc/tools/located_scan.h"
#include "paloc/tools/map_commands.h"
#include "paloc/tools/progress_line.h"
#include "paloc/tools/start_options.h"

namespace paloc {
namespace {

constexpr const char* kExample = R"(Example:
  paloc map locate scan.pcd --map survey.ply --init-pose 1.2,0.4,1.6,90,0,0
  paloc map locate scan.pcd --map survey.ply --init auto --json

SCAN is a point cloud in the sensor's frame, which is the body here. A search takes the sensor to be
as upright as --init-pose says, or level, to some 20 degrees; the rest is told from the scan.
Exit codes: 0 found, 2 wrong usage, 3 an input file is wrong, 4 not localized (the reason is told).)";

double secondsSince(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

class MapLocateCommand : public Command {
 public:
  void registerOn(CLI::App& app) override {
    locate_ = app.add_subcommand("locate", "Find the pose of one scan in a map");
    locate_->add_option("SCAN", scan_file_, "point cloud in the sensor's frame")->required();
    locate_->add_option("--map", map_file_, "prior map")->required();
    start_.registerOn(*locate_, "(the sensor)");
    options_.registerOn(*locate_);
    locate_->add_flag("--no-side-file", no_side_file_, "neither read nor write MAP.paloc");
    locate_->add_flag("--json", json_, "one JSON object on standard output");
    locate_->footer(kExample);
  }

  bool called() const override { return locate_->parsed(); }

  ExitCode run() override {
    Config config = options_.load();
    if (no_side_file_) config.map.side_file = false;
    const std::optional<StartGuess> guess = start_.guess();
    if (!guess) throw UsageError("map locate: give --init-pose, --init-position or --init auto");
    LocatedScan located{scan_file_, map_file_, {}, 0, 0};
    const auto scan = scanOf(loadCloud(scan_file_));
    const auto start = std::chrono::steady_clock::now();
    ProgressLine line;
    const auto map = PriorMap::load(map_file_, config.map, [&line](double share) {
      line.show("reading the map  " + std::to_string(static_cast<int>(100 * share)) + " %");
    });
    line.finish();
    located.load_s = secondsSince(start);
    const auto matcher = ScanMatcher::onto(map, config.matcher);
    const auto loaded = std::chrono::steady_clock::now();
    located.match = matcher->locate(scan, *guess);
    located.locate_s = secondsSince(loaded);
    std::cout << (json_ ? jsonOf(located).dump(2) + '\n' : tableOf(located)) << std::flush;
    if (!std::cout) throw IoError("the result could not be written to standard output");
    return located.match.accepted() ? ExitCode::kGood : ExitCode::kNoLocalization;
  }

 private:
  static Scan scanOf(const PointCloud& cloud) {
    const Eigen::Vector3f origin = cloud.origin.cast<float>();
    Scan scan;
    for (const Point3f& p : cloud.points) {
      scan.points_body.push_back({p.x + origin.x(), p.y + origin.y(), p.z + origin.z()});
    }
    return scan;
  }

  CLI::App* locate_ = nullptr;
  ConfigOptions options_;
  StartOptions start_;
  std::string scan_file_, map_file_;
  bool json_ = false, no_side_file_ = false;
};

}  // namespace

std::unique_ptr<Command> makeMapLocateCommand() { return std::make_unique<MapLocateCommand>(); }

}  // namespace paloc

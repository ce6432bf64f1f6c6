#include <CLI/CLI.hpp>
#include <algorithm>
#include <cctype>
#include <cstdio>
#include <iostream>
#include <nlohmann/json.hpp>

#include "paloc/core/errors.h"
#include "paloc/map/cloud_io.h"
#include "paloc/tools/map_commands.h"
#include "paloc/tools/progress_line.h"
#include "paloc/tools/result_folder.h"

namespace paloc {
namespace {

constexpr const char* kExample = R"(Example:
  paloc map convert survey.las survey.ply
  paloc map convert scans.txt.gz map.pcd --voxel 0.05 --json

Reads every format that a prior map may have, and writes binary PLY or PCD, in double precision where
the coordinates are large. Exit codes: 0 done, 2 wrong usage, 3 the input cannot be read or the
output not be written.)";

std::string endingOf(const std::filesystem::path& file) {
  std::string ending = file.extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return ending;
}

class MapConvertCommand : public Command {
 public:
  void registerOn(CLI::App& app) override {
    convert_ = app.add_subcommand("convert", "Write a map in another format, thinned on request");
    convert_->add_option("IN", in_, "point cloud")->required();
    convert_->add_option("OUT", out_, "file to write: .ply or .pcd")->required();
    convert_->add_option("--voxel", voxel_m_, "thin to the centroids of voxels of this edge (m)")
        ->check(CLI::Range(0.001, 100.0));
    convert_->add_flag("--overwrite", overwrite_, "replace OUT if it is there");
    convert_->add_flag("--json", json_, "one JSON object on standard output");
    convert_->footer(kExample);
  }

  bool called() const override { return convert_->parsed(); }

  ExitCode run() override {
    const std::string ending = endingOf(out_);
    if (ending != ".ply" && ending != ".pcd") {
      throw UsageError(out_ +
                       ": what is written is PLY or PCD, so the name must end in .ply or .pcd");
    }
    checkNotThere(out_, overwrite_);
    std::error_code ignored;
    if (std::filesystem::equivalent(in_, out_, ignored)) {
      throw UsageError(out_ + ": is the input itself");
    }
    const PointCloud cloud = load();
    ending == ".ply" ? savePly(out_, cloud, "paloc map convert") : savePcd(out_, cloud);
    print(cloud);
    return ExitCode::kGood;
  }

 private:
  PointCloud load() const {
    ProgressLine line;
    const auto progress = [&line](double share) {
      char text[60];
      std::snprintf(text, sizeof text, "%3.0f %%  reading", 100 * share);
      line.show(text);
    };
    PointCloud cloud = loadCloud(in_, {.voxel_m = voxel_m_, .progress = progress});
    line.finish();
    return cloud;
  }

  void print(const PointCloud& cloud) const {
    if (json_) {
      const nlohmann::ordered_json json = {{"input", in_},
                                           {"output", out_},
                                           {"format", cloud.format},
                                           {"points_read", cloud.points_read},
                                           {"nonfinite", cloud.nonfinite_dropped},
                                           {"points_written", cloud.size()},
                                           {"intensity", !cloud.intensity.empty()}};
      std::cout << json.dump(2) << '\n';
    } else {
      std::cout << in_ << " (" << cloud.format << "): " << cloud.points_read << " points, "
                << cloud.nonfinite_dropped << " more not finite; " << cloud.size() << " written to "
                << out_ << '\n';
    }
    std::cout.flush();
    if (!std::cout) throw IoError("the result could not be written to standard output");
  }

  CLI::App* convert_ = nullptr;
  std::string in_, out_;
  double voxel_m_ = 0;
  bool overwrite_ = false;
  bool json_ = false;
};

}  // namespace

std::unique_ptr<Command> makeMapConvertCommand() { return std::make_unique<MapConvertCommand>(); }

}  // namespace paloc

#include <CLI/CLI.hpp>
#include <iostream>
#include <nlohmann/json.hpp>

#include "eval_commands.h"
#include "paloc/core/errors.h"
#include "paloc/map/cloud_io.h"
#include "paloc/tools/eval_changes.h"

namespace paloc {
namespace {

constexpr double kVoxel_m = 0.05;

constexpr const char* kExample = R"(Example:
  paloc synth --change removed-furniture --change added-box -o demo
  paloc replay demo/recording.rawlog --map demo/map.ply --init-tum demo/truth.tum --octomap -o result
  paloc eval changes demo/changes.json result/map_changes.ply --map demo/map.ply --scans result/map.ply

Precision: share of the reported points that lie where the truth has this kind of change. Recall:
share of the points that lie there (of the map: gone; of the scans: all others) with a reported one
within 8 cm, also of those that no ray could reach. "unmapped" is compared with the part that was
left out of the map; shadows of the survey are unmapped as well, but not in the truth.
Exit codes: 0 compared, 2 wrong usage, 3 a file is wrong.)";

class EvalChangesCommand : public Command {
 public:
  void registerOn(CLI::App& eval) override {
    app_ = eval.add_subcommand("changes", "See whether changes of a simulated place were found");
    app_->add_option("TRUTH", truth_, "changes.json of paloc synth --change")->required();
    app_->add_option("CHANGES", changes_, "a result's map_changes.ply")->required();
    app_->add_option("--map", map_, "the prior map: for the recall of what is gone");
    app_->add_option("--scans", scans_, "the result's map.ply: for the recall of all others");
    app_->add_option("--tolerance", tolerance_m_, "of places in the truth (m)")
        ->check(CLI::Range(0.0, 1.0))
        ->capture_default_str();
    app_->add_flag("--json", json_, "one JSON object on standard output");
    app_->footer(kExample);
  }

  bool called() const override { return app_->parsed(); }

  ExitCode run() override {
    EvalChangesInput input;
    const ChangeTruth truth = ChangeTruth::load(truth_);
    input.changes = loadChanges(changes_);
    LoadOptions thinned;
    thinned.voxel_m = kVoxel_m;
    if (!map_.empty()) input.map = loadCloud(map_, thinned);
    if (!scans_.empty()) input.scans = loadCloud(scans_, thinned);
    const EvalChangesResult result = evaluateChanges(truth, input, tolerance_m_);
    std::cout << (json_ ? jsonOf(result).dump(2) + '\n' : tableOf(result)) << std::flush;
    if (!std::cout) throw IoError("the result could not be written to standard output");
    return ExitCode::kGood;
  }

 private:
  CLI::App* app_ = nullptr;
  std::string truth_, changes_, map_, scans_;
  double tolerance_m_ = 0.05;
  bool json_ = false;
};

}  // namespace

std::unique_ptr<Command> makeEvalChangesCommand() { return std::make_unique<EvalChangesCommand>(); }

}  // namespace paloc

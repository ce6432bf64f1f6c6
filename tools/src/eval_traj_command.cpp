#include <CLI/CLI.hpp>
#include <cmath>
#include <iostream>
#include <map>
#include <nlohmann/json.hpp>

#include "eval_commands.h"
#include "paloc/core/errors.h"
#include "paloc/tools/eval_traj.h"

namespace paloc {
namespace {

constexpr const char* kTrajExample = R"(Example:
  paloc eval traj truth.tum result/trajectory.tum
  paloc eval traj truth.tum odometry.tum --align se3 --delta 1 --delta-unit m --json

ATE: absolute trajectory error. RPE: relative pose error over --delta, consecutive pairs.
Definitions are evo's; without --across-gaps, pairs that span a gap are left out and counted.
A gap is a step between matched poses of more than --max-gap; if that is not given, of more than
1.5 median steps, and with --delta-unit m or s of more than 0.5 s, too.
Exit codes: 0 compared, 2 wrong usage, 3 a file is wrong or no pose of the two belongs together.)";

const std::map<std::string, Alignment> kAlignments{{"none", Alignment::kNone},
                                                   {"se3", Alignment::kSe3},
                                                   {"yaw", Alignment::kYaw},
                                                   {"origin", Alignment::kOrigin}};
const std::map<std::string, DeltaUnit> kDeltaUnits{
    {"frames", DeltaUnit::kFrames}, {"m", DeltaUnit::kMetres}, {"s", DeltaUnit::kSeconds}};

// Any longer and the time in nanoseconds overflows; no two poses of a run are a year apart.
constexpr double kLongestTime_s = 3e7;

void check(const EvalTrajSettings& settings) {
  const RelativeErrorSettings& relative = settings.relative;
  const auto isTime = [](double t) { return t >= 0 && t <= kLongestTime_s; };
  if (!(relative.delta > 0 && relative.delta <= kLongestTime_s)) {
    throw UsageError("--delta must be a positive number");
  }
  if (relative.unit == DeltaUnit::kFrames && relative.delta != std::floor(relative.delta)) {
    throw UsageError("--delta must be a whole number with --delta-unit frames");
  }
  if (!isTime(settings.max_dt_s)) throw UsageError("--max-dt must be a time of zero or more (s)");
  if (!isTime(relative.max_gap_s)) throw UsageError("--max-gap must be a time of zero or more (s)");
}

class EvalTrajCommand : public Command {
 public:
  void registerOn(CLI::App& eval) override {
    traj_ = eval.add_subcommand("traj", "Compare two trajectories: ATE, RPE and coverage");
    traj_->add_option("REF", settings_.reference_file, "reference trajectory (TUM)")->required();
    traj_->add_option("EST", settings_.estimate_file, "trajectory to judge (TUM)")->required();
    traj_->add_option("--align", alignment_, "move EST onto REF first")
        ->check(CLI::IsMember(kAlignments))
        ->capture_default_str();
    traj_->add_option("--delta", settings_.relative.delta, "length of the RPE's relative motions")
        ->capture_default_str();
    traj_->add_option("--delta-unit", unit_, "what --delta is counted in")
        ->check(CLI::IsMember(kDeltaUnits))
        ->capture_default_str();
    traj_
        ->add_option("--max-dt", settings_.max_dt_s, "matched poses are at most this far apart (s)")
        ->capture_default_str();
    traj_->add_option("--max-gap", settings_.relative.max_gap_s,
                      "a longer step between poses is a gap (s); default: see below");
    traj_->add_flag("--across-gaps", settings_.relative.across_gaps,
                    "pair poses over gaps, too, as evo does");
    traj_->add_flag("--json", json_, "one JSON object on standard output (m, rad, s)");
    traj_->footer(kTrajExample);
  }

  bool called() const override { return traj_->parsed(); }

  ExitCode run() override {
    settings_.alignment = kAlignments.at(alignment_);
    settings_.relative.unit = kDeltaUnits.at(unit_);
    check(settings_);
    const EvalTrajResult result = evaluateTrajectories(settings_);
    if (json_) {
      for (const std::string& note : result.notes) std::cerr << "note: " << note << '\n';
      std::cout << jsonOf(result).dump(2) << '\n';
    } else {
      std::cout << tableOf(result);
    }
    std::cout.flush();
    if (!std::cout) throw IoError("the result could not be written to standard output");
    return ExitCode::kGood;
  }

 private:
  CLI::App* traj_ = nullptr;
  EvalTrajSettings settings_;
  std::string alignment_ = "none";
  std::string unit_ = "frames";
  bool json_ = false;
};

}  // namespace

std::unique_ptr<Command> makeEvalTrajCommand() { return std::make_unique<EvalTrajCommand>(); }

}  // namespace paloc

#include <gtest/gtest.h>

#include <CLI/CLI.hpp>
#include <map>
#include <nlohmann/json.hpp>

#include "paloc/tools/command.h"
#include "run_program.h"
#include "temp_dir.h"

namespace paloc {
namespace {

using test::ProgramRun;
using test::runPaloc;
using Words = std::vector<std::string>;

/// The sub-commands that take --json, as "eval traj".
void collectWithJson(const CLI::App& app, const std::string& name,
                     std::vector<std::string>& found) {
  if (app.get_option_no_throw("--json") != nullptr) found.push_back(name);
  for (const CLI::App* child : app.get_subcommands([](const CLI::App*) { return true; })) {
    collectWithJson(*child, name.empty() ? child->get_name() : name + " " + child->get_name(),
                    found);
  }
}

/// A smoother problem: a body that rests at the map's origin for a second.
std::string restingProblem() {
  std::string text = "NOISE 0.0012 0.000132 5e-05 5e-06\n";
  for (int k = 0; k <= 10; ++k) {
    const std::string node = std::to_string(k);
    const std::string t = std::to_string(0.1 * k);
    text += "STATE " + node + " " + t + " 0 0 0 0 0 0 1 0 0 0\n";
    if (k > 0) text += "ODOM " + std::to_string(k - 1) + " " + node + " 0 0 0 0 0 0 1 0.002 0.01\n";
    text += "MAP " + node + " 0 0 0 0 0 0 1 0.004 0.02\n";
    for (int i = 0; i < 20; ++i) {
      text += "IMU " + std::to_string(0.1 * k + 0.005 * i) + " 0 0 9.81 0 0 0\n";
    }
  }
  return text;
}

/// A sound call of each sub-command that takes --json, on a recording in `dir`; without --json.
std::map<std::string, Words> soundCalls(const test::TempDir& dir) {
  const std::string log = dir / "demo/recording.rawlog";
  const std::string truth = dir / "demo/truth.tum";
  return {
      {"synth",
       {"synth", "--scene", "building", "--sensor", "vlp-16", "--duration", "2", "-o",
        dir / "another"}},
      {"info", {"info", log}},
      {"replay",
       {"replay", log, "--map", dir / "demo/map.ply", "--init-tum", truth, "-o", dir / "result"}},
      {"eval traj", {"eval", "traj", truth, truth}},
      {"config describe", {"config", "describe"}},
      {"bench smoother", {"bench", "smoother", "--problem", dir / "resting.problem"}},
  };
}

TEST(Json, IsOneObjectOnStandardOutputAndNothingElse) {
  const test::TempDir dir;
  const ProgramRun synth = runPaloc({"synth", "--scene", "building", "--sensor", "vlp-16",
                                     "--duration", "2", "-o", dir / "demo"});
  ASSERT_EQ(synth.exit_code, 0) << synth.err;

  test::writeFile(dir / "resting.problem", restingProblem());

  CLI::App app;
  const auto commands = allCommands();
  for (const auto& command : commands) command->registerOn(app);
  std::vector<std::string> with_json;
  collectWithJson(app, "", with_json);
  const auto calls = soundCalls(dir);
  for (const std::string& name : with_json) {
    const auto call = calls.find(name);
    if (call == calls.end()) {
      ADD_FAILURE() << "paloc " << name << " takes --json: add a call of it to this test";
      continue;
    }
    Words words = call->second;
    words.emplace_back("--json");
    const ProgramRun run = runPaloc(words);
    EXPECT_LE(run.exit_code, 1) << name << ": " << run.err;
    const auto json = nlohmann::json::parse(run.out, nullptr, false);
    EXPECT_TRUE(json.is_object()) << name << " printed: " << run.out.substr(0, 300);
  }
}

}  // namespace
}  // namespace paloc

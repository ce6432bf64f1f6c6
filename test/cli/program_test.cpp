#include <gtest/gtest.h>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "paloc/tools/command.h"
#include "run_program.h"
#include "temp_dir.h"

namespace paloc {
namespace {

using test::ProgramRun;
using test::runPaloc;

/// The words of every sub-command that can be called ("config dump"), as registered.
void collectLeaves(const CLI::App& app, const std::vector<std::string>& words,
                   std::vector<std::vector<std::string>>& leaves) {
  const auto children = app.get_subcommands([](const CLI::App*) { return true; });
  if (children.empty() && !words.empty()) leaves.push_back(words);
  for (const CLI::App* child : children) {
    auto longer = words;
    longer.push_back(child->get_name());
    collectLeaves(*child, longer, leaves);
  }
}

std::vector<std::vector<std::string>> allLeaves() {
  CLI::App app;
  const auto commands = allCommands();
  for (const auto& command : commands) command->registerOn(app);
  std::vector<std::vector<std::string>> leaves;
  collectLeaves(app, {}, leaves);
  return leaves;
}

std::string joined(const std::vector<std::string>& words) {
  std::string text;
  for (const auto& word : words) text += word + " ";
  return text;
}

TEST(Program, TellsItsVersion) {
  const ProgramRun run = runPaloc({"--version"});
  EXPECT_EQ(run.exit_code, 0);
  EXPECT_EQ(run.out, "paloc " PALOC_VERSION "\n");
  EXPECT_EQ(run.err, "");
}

TEST(Program, UsageErrorsExitWithTwoAndSayWhyOnStandardError) {
  const std::vector<std::vector<std::string>> wrong = {
      {}, {"no-such-command"}, {"--no-such-option"}, {"config"}, {"config", "dump", "--no-such"}};
  for (const auto& arguments : wrong) {
    const ProgramRun run = runPaloc(arguments);
    EXPECT_EQ(run.exit_code, 2) << joined(arguments);
    EXPECT_EQ(run.out, "") << joined(arguments);
    EXPECT_NE(run.err, "") << joined(arguments);
  }
}

TEST(Program, HelpOfEverySubcommandHasAnExampleOfIt) {
  const auto leaves = allLeaves();
  ASSERT_FALSE(leaves.empty());
  for (auto words : leaves) {
    const std::string call = "paloc " + joined(words);
    words.emplace_back("--help");
    const ProgramRun run = runPaloc(words);
    EXPECT_EQ(run.exit_code, 0) << call;
    EXPECT_NE(run.out.find("Example"), std::string::npos) << call;
    EXPECT_NE(run.out.find(call), std::string::npos) << call;
    EXPECT_EQ(run.err, "") << call;
  }
}

TEST(Program, MissingInputIsOneSentenceThatNamesIt) {
  const ProgramRun run = runPaloc({"config", "dump", "--config", "no/such.yaml"});
  EXPECT_EQ(run.exit_code, 2);
  EXPECT_EQ(run.err, "paloc: no/such.yaml: no such file\n");
}

TEST(ConfigCommand, DumpLayersFilesAndValues) {
  const test::TempDir dir;
  test::writeFile(dir / "a.yaml", "matcher:\n  max_points: 500\n  min_inliers: 50\n");
  test::writeFile(dir / "b.yaml", "matcher:\n  max_points: 600\n");
  const ProgramRun run =
      runPaloc({"config", "dump", "--config", "vlp-16", "--config", dir / "a.yaml", "--config",
                dir / "b.yaml", "--set", "matcher.threads=1", "--set", "frontend.deskew=false"});
  EXPECT_EQ(run.exit_code, 0) << run.err;
  for (const char* line : {"\n  max_points: 600\n", "\n  min_inliers: 50\n", "\n  threads: 1\n",
                           "\n  deskew: false\n", "\n  max_range_m: 100\n"}) {
    EXPECT_NE(run.out.find(line), std::string::npos) << line;
  }
}

TEST(ConfigCommand, DumpRefusesWhatIsWrong) {
  const ProgramRun run = runPaloc({"config", "dump", "--set", "matcher.max_point=3"});
  EXPECT_EQ(run.exit_code, 2);
  EXPECT_EQ(run.out, "");
  EXPECT_EQ(run.err,
            "paloc: --set matcher.max_point: unknown key; did you mean 'matcher.max_points'?\n");
}

TEST(ConfigCommand, DescribeAsJsonIsOneObjectAndNothingElse) {
  const ProgramRun run = runPaloc({"config", "describe", "--json"});
  EXPECT_EQ(run.exit_code, 0);
  EXPECT_EQ(run.err, "");
  const auto json = nlohmann::json::parse(run.out);
  const auto& row = json.at("settings").at("matcher.fine_distance_m");
  EXPECT_EQ(row.at("unit"), "m");
  EXPECT_EQ(row.at("type"), "double");
  EXPECT_LT(row.at("min"), row.at("default"));
  EXPECT_GT(row.at("max"), row.at("default"));
}

}  // namespace
}  // namespace paloc

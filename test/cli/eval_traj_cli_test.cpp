#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>

#include "run_program.h"
#include "temp_dir.h"

namespace paloc::test {
namespace {

// Two poses a metre apart, and the same 1 cm to the left.
constexpr const char* kReference = "10.0 0 0 0 0 0 0 1\n10.1 1 0 0 0 0 0 1\n";
constexpr const char* kEstimate = "10.0 0 0.01 0 0 0 0 1\n10.1 1 0.01 0 0 0 0 1\n";

class EvalTrajCli : public testing::Test {
 protected:
  void SetUp() override {
    writeFile(folder_ / "ref.tum", kReference);
    writeFile(folder_ / "est.tum", kEstimate);
  }
  TempDir folder_;
};

TEST_F(EvalTrajCli, JsonIsOneObjectAndNothingElse) {
  const auto run = runPaloc({"eval", "traj", folder_ / "ref.tum", folder_ / "est.tum", "--json"});
  EXPECT_EQ(run.exit_code, 0) << run.err;
  const auto json = nlohmann::json::parse(run.out);
  EXPECT_NEAR(json.at("ate").at("rmse_m").get<double>(), 0.01, 1e-12);
  EXPECT_EQ(json.at("poses").at("matched"), 2);
}

TEST_F(EvalTrajCli, TableForPeople) {
  const auto run = runPaloc({"eval", "traj", folder_ / "ref.tum", folder_ / "est.tum"});
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_NE(run.out.find("ATE translation    m      0.0100"), std::string::npos) << run.out;
  EXPECT_TRUE(run.err.empty()) << run.err;
}

TEST_F(EvalTrajCli, HelpHasAnExample) {
  const auto run = runPaloc({"eval", "traj", "--help"});
  EXPECT_EQ(run.exit_code, 0);
  EXPECT_NE(run.out.find("Example:"), std::string::npos);
}

TEST_F(EvalTrajCli, ExitCodesTellWhatIsWrong) {
  const std::string ref = folder_ / "ref.tum", est = folder_ / "est.tum";
  writeFile(folder_ / "late.tum", "99 0 0 0 0 0 0 1\n");
  writeFile(folder_ / "bad.tum", "10.0 0 0 0 0 0 0\n");
  struct Case {
    std::vector<std::string> arguments;
    int exit_code;
    const char* said;
  };
  const Case cases[] = {
      {{ref, folder_ / "late.tum"}, 3, "the nearest two are 88.9 s apart"},
      {{ref, folder_ / "bad.tum"}, 3, "bad.tum:1: a TUM line has 8 fields"},
      {{ref, folder_ / "none.tum"}, 3, "No such file"},
      {{ref, est, "--align", "se3"}, 2, "at least 3 matched poses"},
      {{ref, est, "--align", "up"}, 2, "--align"},
      {{ref, est, "--delta", "0"}, 2, "--delta must be a positive number"},
      {{ref, est, "--delta", "1.5"}, 2, "--delta must be a whole number"},
      {{ref, est, "--max-dt", "-1"}, 2, "--max-dt"},
      {{ref}, 2, "EST"},
  };
  for (const Case& c : cases) {
    std::vector<std::string> arguments{"eval", "traj"};
    arguments.insert(arguments.end(), c.arguments.begin(), c.arguments.end());
    const auto run = runPaloc(arguments);
    EXPECT_EQ(run.exit_code, c.exit_code) << c.said;
    EXPECT_NE(run.err.find(c.said), std::string::npos) << run.err;
    EXPECT_TRUE(run.out.empty()) << run.out;
  }
}

}  // namespace
}  // namespace paloc::test

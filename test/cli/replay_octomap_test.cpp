#include <gtest/gtest.h>
#include <octomap/OcTree.h>

#include "paloc/map/map_changes.h"
#include "replay_demo.h"

namespace paloc {
namespace {

namespace fs = std::filesystem;

test::ReplayRun replayOn(const fs::path& folder, test::Words more, const fs::path& demo = {}) {
  test::ReplayCall call;
  if (!demo.empty()) {
    call.log = demo / "recording.rawlog";
    call.map = demo / "map.ply";
    call.start = {"--init-tum", demo / "truth.tum"};
  }
  call.more = std::move(more);
  return test::replayInto(folder, call);
}

TEST(ReplayOctomap, SameBytesOnEveryRunAndAnyNumberOfThreads) {
  const test::TempDir dir;
  const auto first = replayOn(dir / "first", {"--octomap", "-j", "2"});
  const auto second = replayOn(dir / "second", {"--octomap", "-j", "2"});
  const auto alone = replayOn(dir / "alone", {"--octomap", "-j", "1"});
  ASSERT_EQ(first.exit_code, 0) << first.err;
  for (const char* file : {"octomap.bt", "map_changes.ply"}) {
    const std::string bytes = first.file(file);
    EXPECT_GT(bytes.size(), 300U);
    EXPECT_TRUE(bytes == second.file(file)) << file << " of two runs";
    EXPECT_TRUE(bytes == alone.file(file)) << file << " on one thread";
  }
}

TEST(ReplayOctomap, TellsWhatItFoundAndTheTreeIsAMap) {
  const test::TempDir dir;
  const auto run = replayOn(dir / "result", {"--octomap", "--set", "octomap.resolution_m=0.2"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const auto changes = loadChanges(run.folder / "map_changes.ply");
  for (const MapChange kind : kAllMapChanges) {
    EXPECT_EQ(run.summary.at("changes").at(toString(kind)), changes.count(kind));
  }
  EXPECT_GT(run.summary.at("changes").at("map_points_seen"), 10'000);
  EXPECT_GT(run.summary.at("octomap").at("scans"), 1);
  EXPECT_TRUE(run.summary.at("stage_ms").contains("octomap"));
  EXPECT_EQ(run.summary.at("stage_ms").at("changes").at("calls"), 1);
  EXPECT_NE(run.out.find("\nchanges  "), std::string::npos) << run.out;
  EXPECT_NE(run.file("report.html").find("Differs from the prior map"), std::string::npos);

  const octomap::OcTree tree((run.folder / "octomap.bt").string());
  EXPECT_DOUBLE_EQ(tree.getResolution(), 0.2);
  EXPECT_GT(tree.size(), 1000U);
  const auto info = test::runPaloc({"map", "info", run.folder / "octomap.bt", "--json"});
  EXPECT_LE(info.exit_code, 1) << info.err;
}

TEST(ReplayOctomap, IsThereOnlyWhenAskedForAndReplacedOnlyWhenAskedFor) {
  const test::TempDir dir;
  const auto without = replayOn(dir / "result", {});
  ASSERT_EQ(without.exit_code, 0) << without.err;
  EXPECT_FALSE(fs::exists(dir / "result/octomap.bt"));
  EXPECT_FALSE(fs::exists(dir / "result/map_changes.ply"));
  EXPECT_FALSE(without.summary.contains("changes"));
  EXPECT_EQ(replayOn(dir / "result", {"--octomap"}).exit_code, 2);
  EXPECT_FALSE(fs::exists(dir / "result/octomap.bt"));
  EXPECT_EQ(replayOn(dir / "result", {"--octomap", "--overwrite"}).exit_code, 0);
  EXPECT_TRUE(fs::exists(dir / "result/octomap.bt"));
}

TEST(ReplayOctomap, ATreeThatBecameTooLargeIsTold) {
  const test::TempDir dir;
  const auto run = replayOn(dir / "result", {"--octomap", "--set", "octomap.max_memory_mb=1"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_GT(run.summary.at("octomap").at("scans_left_out"), 0);
  EXPECT_TRUE(run.noted("octomap.max_memory_mb"));
}

TEST(ReplayOctomap, WhatWasChangedIsFound) {
  const test::TempDir dir;
  const fs::path demo = dir / "demo";
  const auto synth = test::runPaloc({"synth", "--sensor", "vlp-16", "--duration", "8",
                                     "--map-spacing", "0.05", "--change", "removed-furniture=1",
                                     "--change", "walking-people=2", "-o", demo});
  ASSERT_EQ(synth.exit_code, 0) << synth.err;
  const auto run = replayOn(dir / "result", {"--octomap"}, demo);
  ASSERT_LE(run.exit_code, 1) << run.err;
  const auto eval =
      test::runPaloc({"eval", "changes", demo / "changes.json", run.folder / "map_changes.ply",
                      "--map", demo / "map.ply", "--scans", run.folder / "map.ply", "--json"});
  ASSERT_EQ(eval.exit_code, 0) << eval.err;
  const auto score = nlohmann::json::parse(eval.out);
  EXPECT_GT(score.at("gone").at("precision"), 0.95) << eval.out;
  EXPECT_GT(score.at("gone").at("recall"), 0.3) << eval.out;
  EXPECT_GT(score.at("moved").at("precision"), 0.95) << eval.out;
  EXPECT_GT(score.at("moved").at("recall"), 0.3) << eval.out;
}

TEST(EvalChanges, RefusesWhatIsNoTruthAndNoChanges) {
  const test::TempDir dir;
  test::writeFile(dir / "truth.json", R"({"objects": [{"name": 3}]})");
  test::writeFile(dir / "changes.json", R"({"objects": [], "missing_from_map": []})");
  saveChanges(dir / "changes.ply", {});
  const auto eval = [](const fs::path& truth, const fs::path& changes) {
    return test::runPaloc({"eval", "changes", truth, changes});
  };
  EXPECT_EQ(eval(dir / "changes.json", dir / "changes.ply").exit_code, 0);
  const auto no_truth = eval(dir / "truth.json", dir / "changes.ply");
  EXPECT_EQ(no_truth.exit_code, 3);
  EXPECT_NE(no_truth.err.find("truth.json"), std::string::npos);
  EXPECT_EQ(eval(dir / "none.json", dir / "changes.ply").exit_code, 3);
  EXPECT_EQ(eval(dir / "changes.json", dir / "changes.json").exit_code, 3);
}

}  // namespace
}  // namespace paloc

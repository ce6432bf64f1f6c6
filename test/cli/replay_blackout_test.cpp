#include <gtest/gtest.h>

#include "paloc/frontends/tum_file.h"
#include "replay_demo.h"

/// Nothing was recorded for a while, and the platform went on.
namespace paloc {
namespace {

TEST(ReplayBlackout, TheBodyIsFoundAgainWhereItIs) {
  const test::TempDir dir;
  const auto made = test::runPaloc({"synth", "--scene", "building", "--sensor", "vlp-16",
                                    "--duration", "20", "--seed", "3", "--map-spacing", "0.06",
                                    "--blackout", "6", "14", "-o", dir / "dark"});
  ASSERT_EQ(made.exit_code, 0) << made.err;
  test::ReplayCall call;
  call.log = dir / "dark/recording.rawlog";
  call.map = dir / "dark/map.ply";
  call.start = {"--init-tum", dir / "dark/truth.tum"};
  const test::ReplayRun run = test::replayInto(dir / "result", call);
  EXPECT_EQ(run.exit_code, 1) << "what happened is told: " << run.out;
  EXPECT_EQ(run.summary.at("repairs").at("reanchored"), 1);
  EXPECT_GE(run.summary.at("map_factors").at("refused").at("not confirmed"), 5);

  const auto truth = readTum(dir / "dark/truth.tum");
  const auto poses = readTum(run.folder / "trajectory.tum");
  ASSERT_EQ(poses.size(), truth.size() - 80);
  double way_in_the_dark_m = 0;
  std::size_t k = 0;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    if (k < poses.size() && poses[k].t_ns == truth[i].t_ns) {
      EXPECT_LT((poses[k].pose.position - truth[i].pose.position).norm(), 0.02) << k;
      ++k;
    } else {
      way_in_the_dark_m += (truth[i].pose.position - truth[i - 1].pose.position).norm();
    }
  }
  EXPECT_EQ(k, poses.size());
  EXPECT_GT(way_in_the_dark_m, 3) << "further than registration reaches";
}

TEST(ReplayBlackout, MustEndAfterItBegins) {
  const test::TempDir dir;
  const auto run = test::runPaloc({"synth", "--blackout", "6", "5", "-o", dir / "dark"});
  EXPECT_EQ(run.exit_code, 2);
  EXPECT_NE(run.err.find("--blackout: the second time must be after the first"), std::string::npos)
      << run.err;
}

}  // namespace
}  // namespace paloc

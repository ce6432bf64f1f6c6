#include <gtest/gtest.h>

#include "replay_demo.h"

namespace paloc {
namespace {

test::ReplayRun replayOn(const std::filesystem::path& folder, const char* threads) {
  test::ReplayCall call;
  call.more = {"-j", threads};
  auto run = test::replayInto(folder, call);
  EXPECT_EQ(run.exit_code, 0) << run.err;
  return run;
}

TEST(ReplayDeterminism, SameBytesOnEveryRunAndAnyNumberOfThreads) {
  const test::TempDir dir;
  const auto first = replayOn(dir / "first", "2");
  const auto second = replayOn(dir / "second", "2");
  const auto alone = replayOn(dir / "alone", "1");
  const auto many = replayOn(dir / "many", "5");
  EXPECT_EQ(first.tumRows(), 50U);
  for (const char* file : {"trajectory.tum", "trajectory_cov.csv", "diagnostics.csv", "map.ply"}) {
    const std::string bytes = first.file(file);
    EXPECT_TRUE(bytes == second.file(file)) << file << " of two runs";
    EXPECT_TRUE(bytes == alone.file(file)) << file << " on one thread";
    EXPECT_TRUE(bytes == many.file(file)) << file << " on five threads";
  }
}

}  // namespace
}  // namespace paloc

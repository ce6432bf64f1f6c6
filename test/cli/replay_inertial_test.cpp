#include <gtest/gtest.h>

#include "paloc/frontends/tum_file.h"
#include "replay_demo.h"

namespace paloc {
namespace {

/// Replays with a front-end of paloc's own, of LiDAR and IMU.
class ReplayInertial : public testing::TestWithParam<const char*> {};

TEST_P(ReplayInertial, LocalizesWithoutTheRecordingsOdometry) {
  const test::TempDir dir;
  auto observations = test::demoObservations();
  std::erase_if(observations, [](const auto& o) { return o->sensorLabel == "odometry"; });
  test::ReplayCall call;
  call.log = dir / "no_odometry.rawlog";
  test::writeLog(call.log, observations);
  call.more = {"--frontend", GetParam()};
  const auto run = test::replayInto(dir / "result", call);
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_EQ(run.tumRows(), 50U);
  const auto truth = readTum(test::demoFolder() / "truth.tum");
  const auto estimate = readTum(run.folder / "trajectory.tum");
  ASSERT_EQ(truth.size(), estimate.size());
  for (std::size_t i = 0; i < truth.size(); ++i) {
    EXPECT_LT((truth[i].pose.position - estimate[i].pose.position).norm(), 0.015) << i;
  }
}

TEST_P(ReplayInertial, SameBytesOnOneThreadAndOnTwo) {
  const test::TempDir dir;
  test::ReplayCall call;
  call.more = {"--frontend", GetParam(), "-j", "1"};
  const auto one = test::replayInto(dir / "one", call);
  call.more.back() = "2";
  const auto two = test::replayInto(dir / "two", call);
  ASSERT_EQ(one.exit_code, 0) << one.err;
  for (const char* file : {"trajectory.tum", "trajectory_cov.csv", "diagnostics.csv"}) {
    EXPECT_TRUE(one.file(file) == two.file(file)) << file;
  }
}

INSTANTIATE_TEST_SUITE_P(ReplayKinds, ReplayInertial, testing::Values("fast_lio", "lio_sam"),
                         [](const auto& kind) { return std::string(kind.param); });

}  // namespace
}  // namespace paloc

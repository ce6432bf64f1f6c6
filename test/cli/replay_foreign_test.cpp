#include <gtest/gtest.h>

#include "replay_demo.h"

namespace paloc {
namespace {

// Recordings of one scan that come with MRPT (Debian's mrpt-common).
class ReplayForeign : public testing::TestWithParam<const char*> {};

TEST_P(ReplayForeign, ScanIsReadAndTheLackOfATrajectoryExplained) {
  test::ReplayCall call;
  call.log = std::string("/usr/share/mrpt/datasets/") + GetParam() + ".rawlog";
  if (!std::filesystem::exists(call.log)) GTEST_SKIP() << call.log << " is not there";
  const test::TempDir dir;
  const auto far = test::replayInto(dir / "far", call);
  EXPECT_EQ(far.exit_code, 4) << far.err;
  EXPECT_NE(far.sentence().find("the initial pose was refused at the only scan tried: "),
            std::string::npos)
      << far.sentence();
  EXPECT_TRUE(far.noted("LiDAR 'Velodyne1_SCAN'")) << far.err;
  call.start = {};
  const auto none = test::replayInto(dir / "none", call);
  EXPECT_EQ(none.exit_code, 4) << none.err;
  EXPECT_NE(none.sentence().find("no initial pose was given"), std::string::npos);
}

INSTANTIATE_TEST_SUITE_P(Mrpt, ReplayForeign,
                         testing::Values("test_velodyne_VLP16", "rot_scan_velodyne"));

}  // namespace
}  // namespace paloc

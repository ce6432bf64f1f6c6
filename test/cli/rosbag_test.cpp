#include <gtest/gtest.h>

#include "paloc/frontends/tum_file.h"
#include "paloc/tools/rosbag_reader.h"
#include "replay_demo.h"

namespace paloc {
namespace {

using test::runPaloc;

// By way of a bag, or told what to install.
TEST(ReplayRosbag, RoundTripGivesTheSameTrajectory) {
  const test::TempDir dir;
  const auto exported = runPaloc({"export", "rosbag", test::demoLog(), "-o", dir / "a.bag"});
  if (!builtWithRosbag()) {
    EXPECT_EQ(exported.exit_code, 2);
    EXPECT_NE(exported.err.find("librosbag-storage-dev"), std::string::npos) << exported.err;
    return;
  }
  ASSERT_EQ(exported.exit_code, 0) << exported.err;
  const auto imported = runPaloc({"import", "rosbag", dir / "a.bag", "-o", dir / "b.rawlog"});
  ASSERT_EQ(imported.exit_code, 0) << imported.err;
  EXPECT_NE(imported.out.find("field 't' (integer), read as nanoseconds"), std::string::npos);
  test::ReplayCall call;
  test::replayInto(dir / "direct", call);
  call.log = dir / "b.rawlog";
  test::replayInto(dir / "by_bag", call);
  const auto direct = readTum(dir / "direct/trajectory.tum");
  const auto by_bag = readTum(dir / "by_bag/trajectory.tum");
  ASSERT_EQ(direct.size(), by_bag.size());
  for (std::size_t i = 0; i < direct.size(); ++i) {
    EXPECT_EQ(direct[i].t_ns, by_bag[i].t_ns);
    EXPECT_LT((direct[i].pose.position - by_bag[i].pose.position).norm(), 1e-4);
  }
}

}  // namespace
}  // namespace paloc

#include "paloc/frontends/imu_clock.h"

#include <gtest/gtest.h>

namespace paloc {
namespace {

constexpr TimeNs kMs = 1'000'000;

TEST(ImuClock, LeavesStampsWithoutAnOffset) {
  ImuClock clock;
  for (TimeNs until = 0; until < 1000 * kMs; until += 100 * kMs) {
    clock.reach(until, 0);
    for (TimeNs t = until + kMs; t <= until + 100 * kMs; t += 5 * kMs) {
      EXPECT_EQ(clock.toLidar(t), t);
    }
  }
}

TEST(ImuClock, ComesToAnOffsetEvenlyAndNeverRunsBackwards) {
  ImuClock clock;
  clock.reach(0, 0);
  EXPECT_EQ(clock.toLidar(0), 0);
  clock.reach(100 * kMs, 20 * kMs);
  TimeNs last = 0;
  for (TimeNs t = kMs; t <= 104 * kMs; t += kMs) {
    const TimeNs by_lidar = clock.toLidar(t);
    EXPECT_GT(by_lidar, last) << t;
    last = by_lidar;
    if (t == 50 * kMs) {
      EXPECT_EQ(by_lidar, 40 * kMs) << "half way there";
    } else if (t >= 100 * kMs) {
      EXPECT_EQ(by_lidar, t - 20 * kMs);
    }
  }
  clock.reach(110 * kMs, -60 * kMs);  // a jump forward is no trouble, one back is:
  EXPECT_EQ(clock.toLidar(110 * kMs), 170 * kMs);
  clock.reach(112 * kMs, 60 * kMs);
  EXPECT_EQ(clock.toLidar(112 * kMs), 170 * kMs + 1);
}

}  // namespace
}  // namespace paloc

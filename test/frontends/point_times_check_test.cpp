#include <gtest/gtest.h>

#include "checked_streams.h"

namespace paloc::test::checked {
namespace {

template <typename Change>
Checked scansWith(const Change& change) {
  Observations scans;
  for (int i = 0; i < 20; ++i) {
    const auto scan = recorded::scanAt(kT0 + i * recorded::kScan);
    change(dynamic_cast<obs::CObservationLidarScan&>(*scan));
    scans.push_back(scan);
  }
  return check(scans);
}

Checked timesOf(const std::function<std::uint32_t(std::uint32_t)>& time) {
  return scansWith([&](obs::CObservationLidarScan& scan) {
    for (std::uint32_t& dt : scan.dt_ns) dt = time(dt);
  });
}

TEST(PointTimesCheck, FindsNothingInSoundTimes) {
  EXPECT_EQ(timesOf([](std::uint32_t dt) { return dt; }).wrong(), "");
  // A solid-state sensor may take a fifth of its period; another one overlaps the next scan.
  EXPECT_EQ(timesOf([](std::uint32_t dt) { return dt / 5; }).wrong(), "");
  EXPECT_EQ(timesOf([](std::uint32_t dt) { return dt + dt / 5; }).wrong(), "");
}

TEST(PointTimesCheck, NamesAWrongUnit) {
  const Checked small = timesOf([](std::uint32_t dt) { return dt / 1000; });
  EXPECT_EQ(small.wrong(), "point-times");
  EXPECT_NE(small.sentence("point-times").find("a factor of 1000"), std::string::npos);
  const Checked tiny = timesOf([](std::uint32_t dt) { return dt / 100'000; });
  EXPECT_EQ(tiny.wrong(), "point-times");
  const Checked large = timesOf([](std::uint32_t dt) { return 10 * dt; });
  EXPECT_EQ(large.wrong(), "point-times");
  EXPECT_NEAR(*large.find("point-times")->value, 1.0, 0.02);
}

TEST(PointTimesCheck, FindsEqualTimes) {
  const Checked checked = timesOf([](std::uint32_t) { return 7'000'000U; });
  EXPECT_NE(checked.sentence("point-times").find("all the same"), std::string::npos);
}

TEST(PointTimesCheck, KnowsTimesBeforeTheEndThatWrappedRound) {
  const Checked checked = timesOf([](std::uint32_t dt) { return dt - 100'000'000U; });
  EXPECT_NE(checked.sentence("point-times").find("negative"), std::string::npos);
}

TEST(PointTimesCheck, ScansWithoutTimesAreANote) {
  const auto forget = [](obs::CObservationLidarScan& scan) { scan.dt_ns.clear(); };
  const auto told = [](const Checked& checked, const std::string& part) {
    return std::any_of(checked.findings.begin(), checked.findings.end(), [&](const Finding& f) {
      return f.severity == Severity::kNote && f.sentence.find(part) != std::string::npos;
    });
  };
  const Checked checked = scansWith(forget);
  EXPECT_EQ(checked.wrong(), "");
  EXPECT_TRUE(told(checked, "as if taken at one instant"));
  const Checked deskewed = scansWith([&](obs::CObservationLidarScan& scan) {
    forget(scan);
    scan.deskewed = true;
  });
  EXPECT_FALSE(told(deskewed, "as if taken at one instant"));
  EXPECT_TRUE(told(deskewed, "it says that it is deskewed to its end"));
}

}  // namespace
}  // namespace paloc::test::checked

#include <gtest/gtest.h>

#include <cmath>

#include "checked_streams.h"
#include "paloc/frontends/mrpt_time.h"

// Stamps, rates, gaps and what cannot be read.
namespace paloc::test::checked {
namespace {

void shift(const CObservation::Ptr& observation, TimeNs by_ns) {
  observation->timestamp = toMrptTime(fromMrptTime(observation->timestamp) + by_ns);
}

TEST(StreamChecks, FindNothingInASoundStream) {
  EXPECT_EQ(check(imuStream(2000)).wrong(), "");
  EXPECT_EQ(check(odometryStream(100)).wrong(), "");
  EXPECT_EQ(check({}).wrong(), "");
}

TEST(StampCheck, CountsRewindsAndTellsTheFurthest) {
  Observations imu = imuStream(1000);
  for (std::size_t i = 500; i < imu.size(); ++i) shift(imu[i], -300 * kMs);
  const Checked checked = check(imu);
  ASSERT_TRUE(checked.find("rewind"));
  EXPECT_NEAR(*checked.find("rewind")->value, 0.295, 1e-6);
  EXPECT_EQ(*checked.find("rewind")->t_ns, kT0 + 499 * 5 * kMs);
  EXPECT_NE(checked.sentence("rewind").find("once"), std::string::npos);
}

TEST(StampCheck, CountsRepeatedStamps) {
  Observations imu = imuStream(1000);
  for (int i = 900; i > 0; i -= 100) imu.insert(imu.begin() + i, imu[static_cast<std::size_t>(i)]);
  const Checked checked = check(imu);
  EXPECT_EQ(checked.wrong(), "duplicates");
  EXPECT_EQ(*checked.find("duplicates")->value, 9);
}

TEST(RateCheck, TellsGapsFromAMissingSample) {
  Observations imu = imuStream(2000);
  imu.erase(imu.begin() + 1000);  // 10 ms without one is no gap
  EXPECT_EQ(check(imu).wrong(), "");
  imu.erase(imu.begin() + 500, imu.begin() + 700);
  const Checked checked = check(imu);
  EXPECT_EQ(checked.wrong(), "gaps");
  EXPECT_NEAR(*checked.find("gaps")->value, 1.005, 1e-9);
  EXPECT_EQ(*checked.find("gaps")->t_ns, kT0 + 499 * 5 * kMs);
}

TEST(RateCheck, AScanThatIsMissingIsAGap) {
  Observations scans;
  for (int i = 0; i < 40; ++i) {
    if (i != 20) scans.push_back(recorded::scanAt(kT0 + i * recorded::kScan));
  }
  EXPECT_EQ(check(scans).wrong(), "gaps");
}

TEST(RateCheck, SlowStreamsAreTold) {
  EXPECT_EQ(check(imuStream(300, 16 * kMs)).wrong(), "");  // 62.5 Hz
  const Checked checked = check(imuStream(300, 40 * kMs));
  EXPECT_EQ(checked.wrong(), "rate");
  EXPECT_NEAR(*checked.find("rate")->value, 25, 0.3);
  EXPECT_EQ(check(odometryStream(50, 600 * kMs)).wrong(), "rate");
}

TEST(RateCheck, StampsOfArrivalAreUneven) {
  Observations imu = imuStream(2000);
  for (std::size_t i = 0; i < imu.size(); ++i) {
    shift(imu[i], static_cast<TimeNs>(3 - i % 4) * 49 * kMs / 10);
  }
  EXPECT_EQ(check(imu).wrong(), "uneven");
}

TEST(RateCheck, ALittleJitterIsNotUneven) {
  Observations imu = imuStream(2000);
  for (std::size_t i = 0; i < imu.size(); ++i) shift(imu[i], static_cast<TimeNs>(i % 3) * kMs / 3);
  EXPECT_EQ(check(imu).wrong(), "");
}

TEST(RateCheck, EveryFourthScanMissingIsNotUneven) {
  Observations poses = imuStream(2000);
  Observations thinned;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    if (i % 4 != 3) thinned.push_back(poses[i]);
  }
  EXPECT_EQ(check(thinned).wrong(), "");
}

TEST(RefusedCheck, CountsWhatIsNotFinite) {
  Observations imu = imuStream(1000);
  for (std::size_t i = 10; i < imu.size(); i += 100) {
    imuOf(imu[i]).set(mrpt::obs::IMU_WY, std::nan(""));
  }
  const Checked checked = check(imu);
  EXPECT_EQ(checked.wrong(), "non-finite");
  EXPECT_EQ(*checked.find("non-finite")->value, 10);
  EXPECT_EQ(checked.find("non-finite")->severity, Severity::kWarning);
}

TEST(RefusedCheck, AnImuAwayFromTheBodyIsAnError) {
  Observations imu = imuStream(1000);
  for (const auto& sample : imu) sample->setSensorPose(mrpt::poses::CPose3D(0.1, 0, 0, 0, 0, 0));
  const Checked checked = check(imu);
  ASSERT_TRUE(checked.find("unreadable"));
  EXPECT_EQ(checked.find("unreadable")->severity, Severity::kError);
  EXPECT_NE(checked.sentence("unreadable").find("body's origin"), std::string::npos);
}

TEST(RefusedCheck, NoReturnsAreNoFaultButAnEmptyScanIs) {
  Observations scans;
  for (int i = 0; i < 30; ++i) {
    const auto scan = recorded::scanAt(kT0 + i * recorded::kScan);
    auto& lidar = dynamic_cast<obs::CObservationLidarScan&>(*scan);
    lidar.x[5] = NAN;  // how many drivers mark a ray without return
    if (i == 7) std::fill(lidar.x.begin(), lidar.x.end(), NAN);
    scans.push_back(scan);
  }
  const Checked checked = check(scans);
  EXPECT_EQ(checked.wrong(), "unreadable");
  EXPECT_EQ(*checked.find("unreadable")->value, 1);
}

TEST(RepeatedCheck, SamplesHeldForAHigherRateAreTold) {
  Observations imu = imuStream(1000);
  for (std::size_t i = 1; i < imu.size(); i += 2) {
    const auto stamp = imu[i]->timestamp;
    imu[i] = std::make_shared<recorded::CObservationIMU>(imuOf(imu[i - 1]));
    imu[i]->timestamp = stamp;
  }
  const Checked checked = check(imu);
  EXPECT_EQ(checked.wrong(), "repeated-values");
  EXPECT_NEAR(*checked.find("repeated-values")->value, 0.5, 0.01);
}

TEST(DataChecks, LookAtEachStreamApart) {
  Observations second;
  for (int i = 0; i < 1000; ++i) {
    auto sample = recorded::imuAt(kT0 + i * 5 * kMs, "second");
    imuOf(sample).set(mrpt::obs::IMU_Z_ACC, 0.0);
    second.push_back(sample);
  }
  const Checked checked = check(merged({imuStream(1000), second}));
  EXPECT_EQ(checked.wrong(), "acceleration-unit");
  EXPECT_EQ(checked.find("acceleration-unit")->label, "second");
}

}  // namespace
}  // namespace paloc::test::checked

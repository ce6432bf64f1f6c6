#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "paloc/core/errors.h"
#include "paloc/core/mrpt_pose.h"
#include "paloc/frontends/imu_reader.h"
#include "paloc/frontends/mrpt_time.h"
#include "paloc/tools/motion_observations.h"
#include "paloc/tools/synth_fault_injector.h"

namespace paloc::synth {
namespace {

constexpr TimeNs kStart = 1'700'000'000 * kNsPerSecond;
constexpr TimeNs kMs = 1'000'000;

mrpt::obs::CObservationIMU imuAt(double t_s) {
  return imuObservation({kStart + nsFromSeconds(t_s), Vec3(0.1, 0.2, 9.8), Vec3(0.4, -0.5, 0.6)},
                        "imu");
}

obs::CObservationLidarScan scanAt(double t_s) {
  obs::CObservationLidarScan scan;
  scan.timestamp = toMrptTime(kStart + nsFromSeconds(t_s));
  scan.x = scan.y = scan.z = {1, 2};
  scan.dt_ns = {0, 99'000'000};
  scan.duration_ns = 99'000'000;
  scan.sensorPoseOnRobot = mrpt::poses::CPose3D(0.1, 0.2, 0.3, 0.4, 0.5, 0.6);
  return scan;
}

/// What becomes of observations.
template <typename Observation>
std::vector<Observation> passed(const std::string& fault, const std::vector<Observation>& all) {
  FaultInjector injector({parseFault(fault)}, kStart);
  std::vector<Observation> result;
  for (const Observation& one : all) {
    injector.pass(one, [&](const mrpt::obs::CObservation& spoiled) {
      result.push_back(dynamic_cast<const Observation&>(spoiled));
    });
  }
  return result;
}

ImuSample imuWith(const std::string& fault) {
  std::string refusal;
  return decodeImu(passed(fault, std::vector{imuAt(1)}).at(0), refusal).value();
}

obs::CObservationLidarScan scanWith(const std::string& fault) {
  return passed(fault, std::vector{scanAt(1)}).at(0);
}

TimeNs delay(const mrpt::obs::CObservation& observation) {
  return fromMrptTime(observation.timestamp) - kStart - kNsPerSecond;
}

std::vector<mrpt::obs::CObservationIMU> imuStream(int count) {
  std::vector<mrpt::obs::CObservationIMU> all;
  for (int i = 0; i < count; ++i) all.push_back(imuAt(0.005 * i));
  return all;
}

TEST(SynthFault, IsReadWithItsDefaultsAndItsValues) {
  EXPECT_EQ(parseFault("clock-offset").values, std::vector<double>{0.01});
  EXPECT_EQ(parseFault("clock-offset=-0.005").values, std::vector<double>{-0.005});
  EXPECT_EQ(parseFault("imu-gap=3,4.5").values, (std::vector<double>{3, 4.5}));
  EXPECT_TRUE(parseFault("imu-g").values.empty());
  EXPECT_EQ(toString(parseFault("rewind").kind), "rewind");
}

TEST(SynthFault, RefusesWhatItCannotRead) {
  for (const char* wrong : {"no-such", "imu-g=1", "imu-gap=3", "imu-gap=4,3", "clock-offset=x",
                            "clock-offset=", "clock-offset=11", "rewind=1,2,3"}) {
    EXPECT_THROW(parseFault(wrong), UsageError) << wrong;
  }
}

TEST(SynthFault, SpoilsWhatTheImuReads) {
  constexpr double kDegree = std::numbers::pi / 180;
  EXPECT_NEAR(imuWith("imu-g").acc_body.z(), 9.8 / 9.80665, 1e-12);
  EXPECT_NEAR(imuWith("imu-g").omega_body.z(), 0.6, 1e-12);
  EXPECT_NEAR(imuWith("gyro-deg").omega_body.x(), 0.4 / kDegree, 1e-9);
  EXPECT_EQ(imuWith("imu-mirrored").acc_body, Vec3(0.1, -0.2, 9.8));
  EXPECT_EQ(imuWith("imu-swapped").omega_body, Vec3(-0.5, 0.4, 0.6));
  EXPECT_LT((imuWith("imu-turned=90").omega_body - Vec3(-0.5, -0.4, 0.6)).norm(), 1e-12);
  EXPECT_EQ(imuWith("gyro-saturation=0.45").omega_body, Vec3(0.4, -0.45, 0.45));
  EXPECT_EQ(imuWith("acc-saturation=9").acc_body, Vec3(0.1, 0.2, 9));
}

TEST(SynthFault, SpoilsStamps) {
  EXPECT_EQ(delay(passed("clock-offset=-0.02", std::vector{imuAt(1)}).at(0)), -20 * kMs);
  EXPECT_EQ(delay(scanWith("clock-offset")), 0);
  EXPECT_EQ(delay(scanWith("scan-stamp-end")), 99 * kMs);
  EXPECT_EQ(delay(scanWith("rewind=1,0.25")), -250 * kMs);
  EXPECT_EQ(delay(scanWith("rewind=1.1,0.25")), 0);
}

TEST(SynthFault, LeavesOutAndRepeats) {
  EXPECT_EQ(passed("imu-gap=1,2", imuStream(600)).size(), 400U);
  EXPECT_EQ(passed("lidar-gap=1,2", imuStream(600)).size(), 600U);
  EXPECT_TRUE(passed("lidar-gap=1,2", std::vector{scanAt(1.5)}).empty());
  EXPECT_EQ(passed("duplicates", imuStream(600)).size(), 630U);
  EXPECT_NEAR(static_cast<double>(passed("imu-rate=20", imuStream(600)).size()), 60, 1);
  const StampedPose pose{kStart + kNsPerSecond, Pose{}};
  EXPECT_TRUE(passed("odometry-gap=0.5,2", std::vector{poseObservation(pose, "odometry")}).empty());
}

TEST(SynthFault, MakesBurstsOfSamples) {
  const auto uneven = passed("imu-uneven", imuStream(32));
  for (std::size_t i = 1; i < uneven.size(); ++i) {
    const double step = 1e-6 * static_cast<double>(delay(uneven[i]) - delay(uneven[i - 1]));
    EXPECT_NEAR(step, i % 8 == 0 ? 39.3 : 0.1, 1e-6) << i;
  }
}

TEST(SynthFault, PutsInNumbersThatAreNone) {
  int not_finite = 0;
  for (const auto& imu : passed("non-finite", imuStream(200))) {
    not_finite += std::isnan(imu.get(mrpt::obs::IMU_X_ACC));
  }
  EXPECT_EQ(not_finite, 4);
}

TEST(SynthFault, SpoilsTheMounting) {
  const Pose given = fromMrpt(scanAt(1).sensorPoseOnRobot);
  const auto mounting = [](const std::string& fault) {
    return fromMrpt(scanWith(fault).sensorPoseOnRobot);
  };
  EXPECT_LT(boxminus(mounting("extrinsics-inverted"), given.inverse()).norm(), 1e-9);
  const Pose yaw = mounting("extrinsics-yaw") * given.inverse();
  EXPECT_LT((so3::log(yaw.rotation) - Vec3(0, 0, std::numbers::pi / 2)).norm(), 1e-9);
  const Pose pitch = mounting("extrinsics-pitch=-5") * given.inverse();
  EXPECT_NEAR(so3::log(pitch.rotation).y(), -5 * std::numbers::pi / 180, 1e-9);
}

TEST(SynthFault, SpoilsPointTimes) {
  EXPECT_EQ(scanWith("point-times-unit").dt_ns, (std::vector<std::uint32_t>{0, 99'000}));
  EXPECT_EQ(scanWith("point-times-unit=40").dt_ns, (std::vector<std::uint32_t>{0, 3'960'000'000}));
  EXPECT_EQ(scanWith("point-times-constant").dt_ns, (std::vector<std::uint32_t>{0, 0}));
  const auto from_end = scanWith("point-times-from-end");
  EXPECT_EQ(static_cast<std::int32_t>(from_end.dt_ns[0]), -99'000'000);
  EXPECT_EQ(from_end.dt_ns[1], 0U);
  EXPECT_EQ(delay(from_end), 99 * kMs);
}

TEST(SynthFault, SeveralActTogether) {
  FaultInjector injector({parseFault("imu-g"), parseFault("clock-offset=0.5")}, kStart);
  int times = 0;
  injector.pass(imuAt(1), [&](const mrpt::obs::CObservation& spoiled) {
    const auto& imu = dynamic_cast<const mrpt::obs::CObservationIMU&>(spoiled);
    EXPECT_NEAR(imu.get(mrpt::obs::IMU_Z_ACC), 9.8 / 9.80665, 1e-12);
    EXPECT_EQ(delay(imu), 500 * kMs);
    ++times;
  });
  EXPECT_EQ(times, 1);
}

}  // namespace
}  // namespace paloc::synth

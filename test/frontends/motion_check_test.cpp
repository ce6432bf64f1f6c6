#include <gtest/gtest.h>

#include <array>
#include <numbers>

#include "checked_streams.h"
#include "paloc/core/mrpt_pose.h"
#include "paloc/frontends/mrpt_time.h"

// How the IMU turned against how LiDAR and odometry turned: unit, axes, clock. A known motion,
// sway() of box_world.h, without noise.
namespace paloc::test::checked {
namespace {

constexpr std::array kAcc = {mrpt::obs::IMU_X_ACC, mrpt::obs::IMU_Y_ACC, mrpt::obs::IMU_Z_ACC};
constexpr std::array kGyro = {mrpt::obs::IMU_WX, mrpt::obs::IMU_WY, mrpt::obs::IMU_WZ};
constexpr double kDegree = std::numbers::pi / 180;

template <typename Change>
void changeImu(const Observations& all, Change change) {
  for (const auto& observation : all) {
    auto* imu = dynamic_cast<recorded::CObservationIMU*>(observation.get());
    if (!imu) continue;
    for (const auto& axes : {kAcc, kGyro}) {
      Vec3 v(imu->get(axes[0]), imu->get(axes[1]), imu->get(axes[2]));
      v = change(v, axes == kGyro);
      for (int i = 0; i < 3; ++i) imu->set(axes[static_cast<std::size_t>(i)], v[i]);
    }
  }
}

void delayImu(const Observations& all, double by_s) {
  for (const auto& observation : all) {
    if (!dynamic_cast<recorded::CObservationIMU*>(observation.get())) continue;
    observation->timestamp = toMrptTime(fromMrptTime(observation->timestamp) + nsFromSeconds(by_s));
  }
}

Observations withOdometry() { return merged({imuStream(4000), odometryStream(200)}); }

// T_body_lidar of the scans; they may say another.
const Pose& mounting() {
  static const Pose T{Vec3(-0.04, 0.01, -0.02), so3::exp(Vec3(0.1, -0.2, 0.3))};
  return T;
}

Observations withScans(int count = 60, const Path& path = test::sway()) {
  Observations scans;
  for (int i = 0; i < count; ++i) {
    auto scan = std::make_shared<obs::CObservationLidarScan>(test::scanRoom(
        {}, path, mounting(), kT0 + 300 * kMs + i * recorded::kScan, 99 * kMs, 240, 16));
    scan->sensorPoseOnRobot = toMrpt(mounting());
    scans.push_back(scan);
  }
  return merged({imuStream(20 * count + 120), scans});
}

const MotionComparison& only(const Checked& checked) {
  EXPECT_EQ(checked.motions.size(), 1U);
  static const MotionComparison kNone;
  return checked.motions.empty() ? kNone : checked.motions.front();
}

TEST(MotionCheck, FindsNothingWrongWithASoundOdometry) {
  const Checked checked = check(withOdometry());
  EXPECT_EQ(checked.wrong(), "");
  EXPECT_TRUE(only(checked).of_odometry);
  EXPECT_NEAR(only(checked).offset_s, 0, 2e-5);
  EXPECT_NEAR(only(checked).gyro_scale, 1, 1e-3);
  EXPECT_LT(only(checked).rotation_error_body.norm(), 1e-3);
}

TEST(MotionCheck, MeasuresTheClockOfAnOdometry) {
  for (const double late_s : {-0.1, -0.003, 0.0012, 0.003, 0.01}) {
    const Observations all = withOdometry();
    delayImu(all, late_s);
    const Checked checked = check(all);
    EXPECT_NEAR(only(checked).offset_s, late_s, 1e-4);
    EXPECT_EQ(checked.wrong(), std::abs(late_s) < 0.002 ? "" : "clock-offset") << late_s;
    if (std::abs(late_s) < 0.002) continue;
    const std::string sentence = checked.sentence("clock-offset");
    EXPECT_NE(sentence.find("need not be the LiDAR's clock"), std::string::npos);
    EXPECT_NE(sentence.find(late_s > 0 ? "subtract" : "add"), std::string::npos);
  }
}

TEST(MotionCheck, KnowsAGyroscopeInDegrees) {
  const Observations all = withOdometry();
  changeImu(all, [](const Vec3& v, bool gyro) { return Vec3(gyro ? v / kDegree : v); });
  const Checked checked = check(all);
  EXPECT_EQ(checked.wrong(), "gyro-unit");
  EXPECT_NE(checked.sentence("gyro-unit").find("deg/s, not rad/s"), std::string::npos);
}

TEST(MotionCheck, AScaleErrorOfThreePercentIsNoWrongUnit) {
  const Observations all = withOdometry();
  changeImu(all, [](const Vec3& v, bool gyro) { return Vec3(gyro ? 1.03 * v : v); });
  EXPECT_EQ(check(all).wrong(), "");
}

TEST(MotionCheck, NamesLeftHandedAxes) {
  const Observations all = withOdometry();
  changeImu(all, [](const Vec3& v, bool) { return Vec3(v.y(), v.x(), v.z()); });
  const Checked checked = check(all);
  EXPECT_EQ(checked.wrong(), "extrinsics");
  EXPECT_NE(checked.sentence("extrinsics").find("left-handed"), std::string::npos);
  EXPECT_NE(checked.sentence("extrinsics").find("as y, x, z"), std::string::npos);
}

TEST(MotionCheck, AnotherPlatformsImuDoesNotFit) {
  Observations all = withOdometry();
  changeImu(all, [k = 0](const Vec3& v, bool gyro) mutable {
    k += gyro;
    const double t = 0.005 * k;
    return gyro ? Vec3(std::sin(2.1 * t), std::cos(3.7 * t), std::sin(5.2 * t)) : v;
  });
  EXPECT_EQ(check(all).wrong(), "motion");
}

TEST(MotionCheck, ABodyThatHardlyTurnsIsANote) {
  Observations all;
  for (int i = 0; i < 2000; ++i) {
    all.push_back(recorded::imuAt(kT0 + i * 5 * kMs));
    if (i % 20 == 0) {
      auto pose = recorded::poseAt(kT0 + i * 5 * kMs);
      pose->pose.mean = mrpt::poses::CPose3D(0.01 * i, 0, 0, 0, 0, 0);
      all.push_back(pose);
    }
  }
  changeImu(all, [](const Vec3& v, bool gyro) { return gyro ? Vec3::Zero() : Vec3(v); });
  const Checked checked = check(all);
  EXPECT_EQ(checked.find("clock-offset"), nullptr);
  ASSERT_TRUE(checked.find("motion"));
  EXPECT_EQ(checked.find("motion")->severity, Severity::kNote);
  EXPECT_FALSE(only(checked).turns);
}

TEST(MotionCheck, FindsNothingWrongWithSoundScans) {
  const Checked checked = check(withScans());
  EXPECT_EQ(checked.wrong(), "");
  EXPECT_FALSE(only(checked).of_odometry);
  EXPECT_TRUE(only(checked).offset_observable);
  EXPECT_NEAR(only(checked).offset_s, 0, 5e-4);
  EXPECT_LT(only(checked).rotation_error_body.norm(), 0.01);
}

TEST(MotionCheck, MeasuresTheClockOfScans) {
  for (const double late_s : {-0.02, 0.003, 0.01}) {
    const Observations all = withScans();
    delayImu(all, late_s);
    const Checked checked = check(all);
    EXPECT_NEAR(only(checked).offset_s, late_s, 1e-3);
    EXPECT_EQ(checked.wrong(), "clock-offset") << late_s;
  }
}

TEST(MotionCheck, StampsOfTheEndAreAScanLate) {
  const Observations all = withScans();
  for (const auto& observation : all) {
    if (dynamic_cast<recorded::CObservationIMU*>(observation.get())) continue;
    observation->timestamp = toMrptTime(fromMrptTime(observation->timestamp) + 99 * kMs);
  }
  const Checked checked = check(all);
  EXPECT_EQ(checked.wrong(), "clock-offset");
  EXPECT_NE(checked.sentence("clock-offset").find("the length of a scan"), std::string::npos);
}

TEST(MotionCheck, TellsTheMountingThatFits) {
  Observations all = withScans();
  for (const auto& observation : all) {
    if (!dynamic_cast<obs::CObservationLidarScan*>(observation.get())) continue;
    observation->setSensorPose(toMrpt(mounting().inverse()));
  }
  const Checked inverse = check(all);
  EXPECT_EQ(inverse.wrong(), "extrinsics");
  EXPECT_NE(inverse.sentence("extrinsics").find("it is its inverse"), std::string::npos);
  EXPECT_NEAR(inverse.find("extrinsics")->value.value(), 2 * so3::log(mounting().rotation).norm(),
              0.02);
  const Pose slightly{mounting().position, mounting().rotation * so3::exp(Vec3(0, 0.01, 0))};
  for (const auto& observation : all) observation->setSensorPose(toMrpt(slightly));
  for (const auto& observation : all) {
    if (dynamic_cast<recorded::CObservationIMU*>(observation.get())) {
      observation->setSensorPose(mrpt::poses::CPose3D());
    }
  }
  EXPECT_EQ(check(all).wrong(), "");  // half a degree is what mountings are known to
}

TEST(MotionCheck, CheapChecksLeaveTheScansAlone) {
  const Observations all = withScans(30);
  delayImu(all, 0.02);
  EXPECT_TRUE(check(all, {}, DataChecks::Extent::kCheap).motions.empty());
}

TEST(MotionCheck, WrongPointTimesAreNotTakenForAWrongClock) {
  const Observations all = withScans(30);
  for (const auto& observation : all) {
    auto* scan = dynamic_cast<obs::CObservationLidarScan*>(observation.get());
    if (scan) std::fill(scan->dt_ns.begin(), scan->dt_ns.end(), 0);
  }
  EXPECT_EQ(check(all).wrong(), "point-times");
}

}  // namespace
}  // namespace paloc::test::checked

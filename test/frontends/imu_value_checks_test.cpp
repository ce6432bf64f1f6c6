#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>

#include "checked_streams.h"

// The unit of the accelerometer, and clipped axes.
namespace paloc::test::checked {
namespace {

constexpr std::array kAcc = {mrpt::obs::IMU_X_ACC, mrpt::obs::IMU_Y_ACC, mrpt::obs::IMU_Z_ACC};
constexpr std::array kAll = {mrpt::obs::IMU_X_ACC, mrpt::obs::IMU_Y_ACC, mrpt::obs::IMU_Z_ACC,
                             mrpt::obs::IMU_WX,    mrpt::obs::IMU_WY,    mrpt::obs::IMU_WZ};

template <typename Fields, typename Change>
Observations changed(const Fields& fields, const Change& change) {
  Observations imu = imuStream(3000);
  for (const auto& sample : imu) {
    for (const auto field : fields) imuOf(sample).set(field, change(imuOf(sample).get(field)));
  }
  return imu;
}

Observations scaled(double factor) {
  return changed(kAcc, [factor](double value) { return factor * value; });
}

TEST(AccelerationCheck, NamesTheUnit) {
  const Checked in_g = check(scaled(1 / 9.81));
  EXPECT_EQ(in_g.wrong(), "acceleration-unit");
  EXPECT_NEAR(*in_g.find("acceleration-unit")->value, 1, 0.05);
  EXPECT_NE(in_g.sentence("acceleration-unit").find("is in g;"), std::string::npos);
  EXPECT_NE(check(scaled(1000 / 9.81)).sentence("acceleration-unit").find("thousandths of g"),
            std::string::npos);
  EXPECT_NE(check(scaled(100)).sentence("acceleration-unit").find("in cm/s2"), std::string::npos);
  EXPECT_NE(check(scaled(2)).sentence("acceleration-unit").find("scale is wrong"),
            std::string::npos);
}

TEST(AccelerationCheck, NoticesThatGravityWasTakenOut) {
  Observations imu = imuStream(3000);
  for (const auto& sample : imu) {
    const double z = imuOf(sample).get(mrpt::obs::IMU_Z_ACC);
    imuOf(sample).set(mrpt::obs::IMU_Z_ACC, z - 9.81);
  }
  EXPECT_NE(check(imu).sentence("acceleration-unit").find("gravity has been taken out"),
            std::string::npos);
}

TEST(AccelerationCheck, LeavesACheapSensorInPeace) {
  EXPECT_EQ(check(scaled(1.05)).wrong(), "");
  EXPECT_EQ(check(scaled(0.95)).wrong(), "");
}

TEST(SaturationCheck, FindsAClippedAxis) {
  const Checked gyro = check(changed(std::array{mrpt::obs::IMU_WZ},
                                     [](double value) { return std::clamp(value, -1.2, 1.2); }));
  EXPECT_EQ(gyro.wrong(), "saturation");
  EXPECT_NEAR(*gyro.find("saturation")->value, 1.2, 1e-12);
  EXPECT_NE(gyro.sentence("saturation").find("gyroscope of the IMU 'imu' (z)"), std::string::npos);
  const Checked acc = check(changed(std::array{mrpt::obs::IMU_Z_ACC},
                                    [](double value) { return std::min(value, 12.0); }));
  EXPECT_EQ(acc.wrong(), "saturation");
}

// Most of the swing lies near to a limit that gravity nearly reaches alone.
TEST(SaturationCheck, FindsALimitJustAboveGravity) {
  std::mt19937 random(2);
  std::normal_distribution<double> noise(0, 0.02);
  Observations imu = imuStream(4000);
  double t_s = 0;
  for (const auto& sample : imu) {
    const double bob = 0.8 * std::sin(11 * t_s) * std::sin(0.3 * t_s);
    imuOf(sample).set(mrpt::obs::IMU_Z_ACC, std::min(9.81 + bob + noise(random), 10.4));
    t_s += 0.005;
  }
  const Checked checked = check(imu);
  EXPECT_EQ(checked.wrong(), "saturation");
  EXPECT_NE(checked.sentence("saturation").find("accelerometer of the IMU 'imu' (z)"),
            std::string::npos);
}

TEST(SaturationCheck, CoarseReadingsAreNotClipped) {
  for (const double bit : {0.001, 0.01, 0.05}) {
    const Checked checked =
        check(changed(kAll, [bit](double value) { return bit * std::round(value / bit); }));
    EXPECT_EQ(checked.find("saturation"), nullptr) << bit << ": " << checked.sentence("saturation");
  }
}

TEST(SaturationCheck, ASensorAtRestMayRepeatItself) {
  std::mt19937 random(1);
  std::normal_distribution<double> noise(0, 0.004);
  Observations imu = imuStream(3000);
  for (const auto& sample : imu) {
    for (const auto field : kAll) {
      const double bit = 0.005, level = field == mrpt::obs::IMU_Z_ACC ? 9.81 : 0;
      imuOf(sample).set(field, bit * std::round((level + noise(random)) / bit));
    }
  }
  EXPECT_EQ(check(imu).find("saturation"), nullptr);
}

}  // namespace
}  // namespace paloc::test::checked

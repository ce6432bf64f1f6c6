#include <gtest/gtest.h>

#include <fstream>

#include "checked_streams.h"
#include "euroc_data.h"
#include "paloc/core/mrpt_pose.h"
#include "paloc/frontends/mrpt_time.h"
#include "shared_data.h"

// Real IMUs: a drone's with its ground truth as odometry (EuRoC), a hand-held LiDAR's in g.
namespace paloc::test::checked {
namespace {

CObservation::Ptr observationOf(const ImuSample& sample) {
  auto imu = recorded::imuAt(sample.t_ns);  // for its class and label; the values follow
  const Vec3 &a = sample.acc_body, &w = sample.omega_body;
  using namespace mrpt::obs;
  imuOf(imu).set(IMU_X_ACC, a.x());
  imuOf(imu).set(IMU_Y_ACC, a.y());
  imuOf(imu).set(IMU_Z_ACC, a.z());
  imuOf(imu).set(IMU_WX, w.x());
  imuOf(imu).set(IMU_WY, w.y());
  imuOf(imu).set(IMU_WZ, w.z());
  return imu;
}

Observations eurocFlight(double imu_late_s) {
  const auto folder = sharedData() / "imu";
  Observations imu, truth;
  for (ImuSample sample : readEurocImu(folder / "euroc_mh05_imu0.txt")) {
    sample.t_ns += nsFromSeconds(imu_late_s);
    imu.push_back(observationOf(sample));
  }
  for (const EurocTruth& row : readEurocTruth(folder / "euroc_mh05_groundtruth.csv")) {
    auto pose = recorded::poseAt(kT0);
    pose->timestamp = toMrptTime(row.t_ns);
    pose->pose.mean = toMrpt(row.state.T_map_body);
    truth.push_back(pose);
  }
  if (imu.empty() || truth.empty()) return {};
  return merged({imu, truth});
}

TEST(RealImu, ADronesImuAgreesWithItsTruth) {
  const Observations sound = eurocFlight(0);
  if (sound.empty()) GTEST_SKIP() << "no data in " << sharedData();
  const Checked checked = check(sound);
  EXPECT_EQ(checked.wrong(), "") << checked.sentence(checked.wrong());
  ASSERT_EQ(checked.motions.size(), 1U);
  EXPECT_NEAR(checked.motions[0].offset_s, 0, 1e-3);
  EXPECT_NEAR(checked.motions[0].gyro_scale, 1, 0.01);
  EXPECT_LT(checked.motions[0].rotation_error_body.norm(), 0.02);

  const Checked late = check(eurocFlight(0.003));
  EXPECT_EQ(late.wrong(), "clock-offset");
  EXPECT_NEAR(late.motions[0].offset_s - checked.motions[0].offset_s, 0.003, 1e-4);
}

TEST(RealImu, AHandHeldImuInGIsNoticed) {
  std::ifstream in(sharedData() / "imu" / "avia_handheld_imu.txt");
  if (!in) GTEST_SKIP() << "no data in " << sharedData();
  Observations imu;
  double t_s = 0;
  ImuSample s;
  Vec3 &w = s.omega_body, &a = s.acc_body;
  while (in >> t_s >> w.x() >> w.y() >> w.z() >> a.x() >> a.y() >> a.z()) {
    s.t_ns = kT0 + nsFromSeconds(t_s);
    imu.push_back(observationOf(s));
  }
  const Checked checked = check(imu);
  EXPECT_EQ(checked.wrong(), "acceleration-unit");
  EXPECT_NE(checked.sentence("acceleration-unit").find("is in g;"), std::string::npos);
}

}  // namespace
}  // namespace paloc::test::checked

#include <gtest/gtest.h>
#include <Eigen/Cholesky>

#include "recorded_walk.h"

namespace paloc {
namespace {

using namespace test::recorded;

double seconds(TimeNs t_ns) { return static_cast<double>(t_ns) * 1e-9; }

/// Scans of a room by a sensor with 32 rings, which sees floor and ceiling, and the IMU, on a path.
std::vector<CObservation::Ptr> recordingOf(const test::Path& path, int scans,
                                           bool with_imu = true) {
  Recording recording;
  for (int i = 0; i < scans; ++i) {
    recording.add(std::make_shared<obs::CObservationLidarScan>(
        test::scanRoom(test::BoxRoom{}, path, Pose{}, kT0 + i * kScan, kScan - kMs, 360, 32)));
  }
  const TimeNs end = kT0 + scans * kScan + 20 * kMs;
  for (TimeNs t = kT0 - 22 * kMs; with_imu && t <= end; t += 5 * kMs) {
    const ImuSample sample = test::imuOnPath(path, t, 9.80665);
    auto imu = std::dynamic_pointer_cast<CObservationIMU>(imuAt(t));
    imu->set(mrpt::obs::IMU_X_ACC, sample.acc_body.x());
    imu->set(mrpt::obs::IMU_Y_ACC, sample.acc_body.y());
    imu->set(mrpt::obs::IMU_Z_ACC, sample.acc_body.z());
    imu->set(mrpt::obs::IMU_WX, sample.omega_body.x());
    imu->set(mrpt::obs::IMU_WY, sample.omega_body.y());
    imu->set(mrpt::obs::IMU_WZ, sample.omega_body.z());
    recording.add(imu);
  }
  return recording.inOrder();
}

Output runLio(const std::vector<CObservation::Ptr>& observations) {
  return run(observations, {}, "fast_lio");
}

Pose errorOf(const test::Path& path, const OdometryFrame& from, const OdometryFrame& to) {
  const Pose truth = path(seconds(from.t_ns)).inverse() * path(seconds(to.t_ns));
  const Pose motion = fromMrpt(from.T_odom_body).inverse() * fromMrpt(to.T_odom_body);
  return truth.inverse() * motion;
}

/// Up to 1.7 m/s and 2 rad/s, from the first scan on.
TEST(FastLioOdometry, FollowsAQuickWalkThatHasBegun) {
  const test::Path path = test::sway();
  const Output output = runLio(recordingOf(path, 60));
  ASSERT_EQ(output.frames.size(), 60U);
  for (std::size_t i = 0; i < 60; ++i) {
    const OdometryFrame& frame = output.frames[i];
    EXPECT_EQ(frame.t_ns, kT0 + static_cast<TimeNs>(i + 1) * kScan - kMs) << "the scan's end";
    EXPECT_EQ(frame.continues, i > 0);
    ASSERT_TRUE(frame.scan) << i;
    if (i > 4) {
      EXPECT_LT(errorOf(path, output.frames[i - 1], frame).position.norm(), 0.01) << i;
      EXPECT_LT(test::worstOffWall({}, path(seconds(frame.t_ns)), frame.scan->points_body), 0.02);
    }
  }
  const Pose error = errorOf(path, output.frames[5], output.frames.back());
  EXPECT_LT(error.position.norm(), 0.02);
  EXPECT_LT(so3::log(error.rotation).norm(), 0.005);
  EXPECT_TRUE(output.problems.empty());
}

TEST(FastLioOdometry, TheFirstScanIsDeskewedByWhatTheSecondTells) {
  const test::Path path = test::constantTwist(Vec3(1.5, 0.5, 0), Vec3(0, 0, 0.8));
  const Output output = runLio(recordingOf(path, 4));
  ASSERT_EQ(output.frames.size(), 4U);
  ASSERT_TRUE(output.frames[0].scan);
  EXPECT_LT(test::worstOffWall({}, path(seconds(output.frames[0].t_ns)),
                               output.frames[0].scan->points_body),
            0.03)
      << "taken as at rest it would be 0.15 m";
}

TEST(FastLioOdometry, SamplesThatReachAFramesEndComeBeforeIt) {
  const Output output = runLio(recordingOf(test::sway(), 8));
  TimeNs newest = 0;
  std::size_t frames = 0;
  for (const FrontendEvent& event : output.events) {
    if (const auto* sample = std::get_if<ImuSample>(&event)) {
      EXPECT_GT(sample->t_ns, newest);
      newest = sample->t_ns;
    } else {
      EXPECT_GE(newest, std::get<OdometryFrame>(event).t_ns);
      EXPECT_LT(newest, std::get<OdometryFrame>(event).t_ns + 6 * kMs);
      ++frames;
    }
  }
  EXPECT_EQ(frames, 8U);
}

TEST(FastLioOdometry, AGapOfTheImuIsBridgedToldAndMakesTheMotionUncertain) {
  auto observations = recordingOf(test::sway(), 30);
  const auto in_gap = [](const auto& o) {
    const TimeNs t = fromMrptTime(o->timestamp);
    return o->sensorLabel == "imu" && t > kT0 + 15 * kScan && t < kT0 + 17 * kScan;
  };
  std::erase_if(observations, in_gap);
  const Output output = runLio(observations);
  ASSERT_EQ(output.frames.size(), 30U);
  EXPECT_TRUE(output.noted("taken as an even motion"));
  const test::Path path = test::sway();
  EXPECT_LT(errorOf(path, output.frames[20], output.frames.back()).position.norm(), 0.03);
  for (std::size_t i = 12; i < 30; ++i) {
    const Pose error = errorOf(path, output.frames[i - 1], output.frames[i]);
    const Mat6& covariance = output.frames[i].motion_covariance;
    EXPECT_LT(error.position.norm(), 0.005 + 3 * std::sqrt(covariance.diagonal().head<3>().sum()))
        << i;
    EXPECT_LT(so3::log(error.rotation).norm(),
              0.001 + 3 * std::sqrt(covariance.diagonal().tail<3>().sum()))
        << i;
  }
}

TEST(FastLioOdometry, WithoutAnImuItSaysWhatItNeeds) {
  const Output output = runLio(recordingOf(test::sway(), 5, false));
  EXPECT_EQ(output.frames.size(), 5U);
  for (const OdometryFrame& frame : output.frames) EXPECT_FALSE(frame.continues);
  EXPECT_TRUE(output.hasProblem("needs an IMU"));
  EXPECT_EQ(output.count("lidar", "scan not used: no IMU data during it"), 5U);
}

TEST(FastLioOdometry, APauseOfTheScansBeginsANewStretch) {
  auto observations = recordingOf(test::sway(), 60);
  std::erase_if(observations, [](const auto& o) {
    const TimeNs t = fromMrptTime(o->timestamp);
    return o->sensorLabel == "lidar" && t > kT0 + 10 * kScan && t < kT0 + 40 * kScan;
  });
  const Output output = runLio(observations);
  ASSERT_EQ(output.frames.size(), 31U);
  for (std::size_t i = 1; i < 31; ++i) EXPECT_EQ(output.frames[i].continues, i != 11) << i;
  EXPECT_TRUE(output.noted("began anew 1 time"));
}

TEST(FastLioOdometry, CovariancesAreSound) {
  const Output output = runLio(recordingOf(test::sway(), 20));
  for (std::size_t i = 1; i < output.frames.size(); ++i) {
    const Eigen::Matrix<double, 6, 6> covariance = output.frames[i].motion_covariance;
    EXPECT_EQ(covariance, covariance.transpose());
    EXPECT_EQ(covariance.llt().info(), Eigen::Success) << i;
    if (i > 3) {
      EXPECT_LT(std::sqrt(covariance(0, 0)), 0.02) << i;
    }
  }
}

}  // namespace
}  // namespace paloc

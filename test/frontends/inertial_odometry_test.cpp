#include <gtest/gtest.h>

#include <Eigen/Cholesky>

#include "recorded_lidar_imu.h"

namespace paloc {
namespace {

using namespace test::recorded;

/// What all front-ends of LiDAR and IMU do.
class InertialOdometry : public testing::TestWithParam<const char*> {
 protected:
  static Output runOn(const std::vector<CObservation::Ptr>& observations) {
    return run(observations, {}, GetParam());
  }
};

/// Up to 1.7 m/s and 2 rad/s, from the first scan on.
TEST_P(InertialOdometry, FollowsAQuickWalkThatHasBegun) {
  const test::Path path = test::sway();
  const Output output = runOn(recordingOf(path, 60));
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

TEST_P(InertialOdometry, TheFirstScanIsDeskewedByWhatTheSecondTells) {
  const test::Path path = test::constantTwist(Vec3(1.5, 0.5, 0), Vec3(0, 0, 0.8));
  const Output output = runOn(recordingOf(path, 4));
  ASSERT_EQ(output.frames.size(), 4U);
  ASSERT_TRUE(output.frames[0].scan);
  EXPECT_LT(test::worstOffWall({}, path(seconds(output.frames[0].t_ns)),
                               output.frames[0].scan->points_body),
            0.03)
      << "taken as at rest it would be 0.15 m";
}

TEST_P(InertialOdometry, SamplesThatReachAFramesEndComeBeforeIt) {
  const Output output = runOn(recordingOf(test::sway(), 8));
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

TEST_P(InertialOdometry, AGapOfTheImuIsBridgedToldAndMakesTheMotionUncertain) {
  auto observations = recordingOf(test::sway(), 30);
  const auto in_gap = [](const auto& o) {
    const TimeNs t = fromMrptTime(o->timestamp);
    return o->sensorLabel == "imu" && t > kT0 + 15 * kScan && t < kT0 + 17 * kScan;
  };
  std::erase_if(observations, in_gap);
  const Output output = runOn(observations);
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

TEST_P(InertialOdometry, WithoutAnImuItSaysWhatItNeeds) {
  const Output output = runOn(recordingOf(test::sway(), 5, false));
  EXPECT_EQ(output.frames.size(), 5U);
  for (const OdometryFrame& frame : output.frames) EXPECT_FALSE(frame.continues);
  EXPECT_TRUE(output.hasProblem("needs an IMU"));
  EXPECT_EQ(output.count("lidar", "scan not used: no IMU data during it"), 5U);
}

TEST_P(InertialOdometry, APauseOfTheScansBeginsANewStretch) {
  auto observations = recordingOf(test::sway(), 60);
  std::erase_if(observations, [](const auto& o) {
    const TimeNs t = fromMrptTime(o->timestamp);
    return o->sensorLabel == "lidar" && t > kT0 + 10 * kScan && t < kT0 + 40 * kScan;
  });
  const Output output = runOn(observations);
  ASSERT_EQ(output.frames.size(), 31U);
  for (std::size_t i = 1; i < 31; ++i) EXPECT_EQ(output.frames[i].continues, i != 11) << i;
  EXPECT_TRUE(output.noted("began anew 1 time"));
}

TEST_P(InertialOdometry, CovariancesAreSound) {
  const Output output = runOn(recordingOf(test::sway(), 20));
  for (std::size_t i = 1; i < output.frames.size(); ++i) {
    const Eigen::Matrix<double, 6, 6> covariance = output.frames[i].motion_covariance;
    EXPECT_EQ(covariance, covariance.transpose());
    EXPECT_EQ(covariance.llt().info(), Eigen::Success) << i;
    if (i > 3) {
      EXPECT_LT(std::sqrt(covariance(0, 0)), 0.02) << i;
    }
  }
}

/// At rest for a second and a half, then off with 0.5 m/s2.
TEST_P(InertialOdometry, BeginsAtRestAsWell) {
  const test::Path path = [](double t) {
    const double moving_s = std::max(t - 6.5, 0.0);
    return Pose{Vec3(0.25 * moving_s * moving_s, 0, 0), Mat3::Identity()};
  };
  const Output output = runOn(recordingOf(path, 40));
  ASSERT_EQ(output.frames.size(), 40U);
  EXPECT_LT(errorOf(path, output.frames[0], output.frames[12]).position.norm(), 0.003);
  EXPECT_LT(errorOf(path, output.frames[0], output.frames[39]).position.norm(), 0.02);
}

TEST_P(InertialOdometry, SameInputSameBytes) {
  const auto observations = recordingOf(test::sway(), 15);
  const Output one = runOn(observations), two = runOn(observations);
  ASSERT_EQ(one.frames.size(), two.frames.size());
  for (std::size_t i = 0; i < one.frames.size(); ++i) {
    const OdometryFrame &a = one.frames[i], &b = two.frames[i];
    EXPECT_EQ(fromMrpt(a.T_odom_body).position, fromMrpt(b.T_odom_body).position);
    EXPECT_EQ(fromMrpt(a.T_odom_body).rotation, fromMrpt(b.T_odom_body).rotation);
    EXPECT_EQ(a.motion_covariance, b.motion_covariance);
  }
}

INSTANTIATE_TEST_SUITE_P(Kinds, InertialOdometry, testing::Values("fast_lio", "lio_sam"),
                         [](const auto& kind) { return std::string(kind.param); });

}  // namespace
}  // namespace paloc

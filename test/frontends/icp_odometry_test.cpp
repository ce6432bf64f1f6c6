#include <gtest/gtest.h>
#include <Eigen/Cholesky>

#include "recorded_lidar_imu.h"

namespace paloc {
namespace {

using namespace test::recorded;

Output runIcp(const std::vector<CObservation::Ptr>& observations) {
  return run(observations, {}, "icp");
}

/// Up to 1.7 m/s and 1.7 rad/s, up and down with 3 m/s2, from the first scan on, without an IMU.
TEST(IcpOdometry, FollowsAQuickWalkByScansAlone) {
  const test::Path path = [](double t) {
    const Vec3 position(1.2 * std::sin(1.1 * t), 0.3 * std::sin(2.3 * t + 1),
                        0.02 * std::sin(12 * t));
    const Vec3 turn(0.03 * std::sin(7 * t), 0.03 * std::cos(5 * t), 1.1 * std::sin(1.5 * t));
    return Pose{position, so3::exp(turn)};
  };
  const Output output = runIcp(recordingOf(path, 60, false));
  ASSERT_EQ(output.frames.size(), 60U);
  for (std::size_t i = 0; i < 60; ++i) {
    const OdometryFrame& frame = output.frames[i];
    EXPECT_EQ(frame.t_ns, kT0 + static_cast<TimeNs>(i + 1) * kScan - kMs) << "the scan's end";
    EXPECT_EQ(frame.continues, i > 0);
    ASSERT_TRUE(frame.scan) << i;
    if (i > 4) {
      EXPECT_LT(errorOf(path, output.frames[i - 1], frame).position.norm(), 0.02) << i;
      EXPECT_LT(test::worstOffWall({}, path(seconds(frame.t_ns)), frame.scan->points_body), 0.15)
          << "not deskewed it would be 0.8 m";
    }
  }
  const Pose error = errorOf(path, output.frames[5], output.frames.back());
  EXPECT_LT(error.position.norm(), 0.03);
  EXPECT_LT(so3::log(error.rotation).norm(), 0.01);
  EXPECT_TRUE(output.problems.empty());
}

TEST(IcpOdometry, TheFirstScanIsDeskewedByWhatTheSecondTells) {
  const test::Path path = test::constantTwist(Vec3(1.5, 0.5, 0), Vec3(0, 0, 0.8));
  const Output output = runIcp(recordingOf(path, 4, false));
  ASSERT_EQ(output.frames.size(), 4U);
  ASSERT_TRUE(output.frames[0].scan);
  EXPECT_LT(test::worstOffWall({}, path(seconds(output.frames[0].t_ns)),
                               output.frames[0].scan->points_body),
            0.08)
      << "taken as at rest it would be 0.15 m";
}

// The odometry knows of no IMU, but its scans are deskewed by one where there is one.
TEST(IcpOdometry, ScansAreDeskewedByTheImuWhereThereIsOne) {
  const test::Path path = [](double t) {
    const Vec3 turn(0.06 * std::sin(20 * t), 0.06 * std::cos(17 * t), 0.8 * std::sin(1.5 * t));
    return Pose{Vec3(0.5 * std::sin(t), 0, 0.02 * std::sin(12 * t)), so3::exp(turn)};
  };
  const auto worst = [&](bool with_imu) {
    const Output output = runIcp(recordingOf(path, 30, with_imu));
    double off = 0;
    for (std::size_t i = 5; i < output.frames.size(); ++i) {
      const OdometryFrame& frame = output.frames[i];
      EXPECT_EQ(frame.scan->v_body_assumed.has_value(), with_imu) << "may be improved on";
      off =
          std::max(off, test::worstOffWall({}, path(seconds(frame.t_ns)), frame.scan->points_body));
    }
    return off;
  };
  EXPECT_LT(worst(true), 0.4 * worst(false));
}

TEST(IcpOdometry, GivesOutTheImuForTheEstimator) {
  const Output output = runIcp(recordingOf(test::sway(), 8));
  EXPECT_EQ(output.frames.size(), 8U);
  EXPECT_GT(output.imu.size(), 150U);
  TimeNs newest = 0;
  for (const FrontendEvent& event : output.events) {
    if (const auto* sample = std::get_if<ImuSample>(&event)) {
      newest = sample->t_ns;
    } else {
      EXPECT_GE(newest, std::get<OdometryFrame>(event).t_ns);
    }
  }
}

TEST(IcpOdometry, AScanOfSomewhereElseIsToldAndMakesTheMotionUncertain) {
  auto observations = recordingOf(test::sway(), 20, false);
  auto& strange = dynamic_cast<obs::CObservationLidarScan&>(*observations[12]);
  for (float& z : strange.z) z += 30;
  const Output output = runIcp(observations);
  ASSERT_EQ(output.frames.size(), 20U);
  EXPECT_TRUE(output.noted("could not be registered"));
  EXPECT_GT(std::sqrt(output.frames[12].motion_covariance(0, 0)), 0.01);
  const Pose error = errorOf(test::sway(), output.frames[11], output.frames.back());
  EXPECT_LT(error.position.norm(), 0.03) << "it goes on in the same map";
}

TEST(IcpOdometry, APauseOfTheScansBeginsANewStretch) {
  auto observations = recordingOf(test::sway(), 60, false);
  observations.erase(observations.begin() + 11, observations.begin() + 40);
  const Output output = runIcp(observations);
  ASSERT_EQ(output.frames.size(), 31U);
  for (std::size_t i = 1; i < 31; ++i) EXPECT_EQ(output.frames[i].continues, i != 11) << i;
  EXPECT_TRUE(output.noted("began anew 1 time"));
}

TEST(IcpOdometry, WithoutPointsItSaysWhatItNeeds) {
  FrontendSettings settings;
  settings.min_range_m = 50;
  const Output output = run(recordingOf(test::sway(), 3, false), settings, "icp");
  EXPECT_TRUE(output.hasProblem("needs a scan with points within range"));
}

TEST(IcpOdometry, CovariancesAreSoundAndBytesTheSame) {
  const auto observations = recordingOf(test::sway(), 20, false);
  const Output output = runIcp(observations), again = runIcp(observations);
  for (std::size_t i = 1; i < output.frames.size(); ++i) {
    const Eigen::Matrix<double, 6, 6> covariance = output.frames[i].motion_covariance;
    EXPECT_EQ(covariance, covariance.transpose());
    EXPECT_EQ(covariance.llt().info(), Eigen::Success) << i;
    EXPECT_EQ(covariance, again.frames[i].motion_covariance);
    EXPECT_EQ(output.frames[i].T_odom_body, again.frames[i].T_odom_body);
    if (i > 3) {
      EXPECT_LT(std::sqrt(covariance(0, 0)), 0.02) << i;
    }
  }
}

// And where a scan is not deskewed, the odometry is that of its end all the same, and says how
// unsure of it.
TEST(IcpOdometry, SaysWhatOfTheMotionIsLeftInItsScans) {
  const test::Path path = test::constantTwist(Vec3(1, 0.2, 0), Vec3(0, 0, 0.2));
  const auto skewOf = [](const Output& output) { return output.frames.back().scan->skew; };
  EXPECT_EQ(skewOf(runIcp(recordingOf(path, 4, true))), ScanSkew::kNone);
  EXPECT_EQ(skewOf(runIcp(recordingOf(path, 4, false))), ScanSkew::kOfOdometry);
  FrontendSettings as_they_are;
  as_they_are.deskew = false;
  const Output output = run(recordingOf(path, 20, false), as_they_are, "icp");
  ASSERT_EQ(output.frames.size(), 20U);
  EXPECT_EQ(skewOf(output), ScanSkew::kWhole);
  for (std::size_t i = 1; i < output.frames.size(); ++i) {
    const OdometryFrame& frame = output.frames[i];
    const Vec6 error = boxminus(errorOf(path, output.frames[i - 1], frame), Pose{});
    const Mat6 covariance = frame.motion_covariance + 1e-8 * Mat6::Identity();
    const Eigen::Matrix<double, 6, 6> inverse = Eigen::Matrix<double, 6, 6>(covariance)
                                                    .ldlt()
                                                    .solve(Eigen::Matrix<double, 6, 6>::Identity());
    EXPECT_LT(error.dot(inverse * error) / 6, 3) << i;
    EXPECT_NEAR(std::sqrt(covariance.topLeftCorner<3, 3>().trace()), 0.051, 0.005)
        << "half of a frame's way";
    if (i > 1) {  // the first pose is that of half the first scan
      EXPECT_LT(error.head<3>().norm(), 2e-3) << i;
    }
  }
}

}  // namespace
}  // namespace paloc

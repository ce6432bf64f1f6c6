#include "recorded_walk.h"

#include <gtest/gtest.h>
#include <mrpt/obs/CObservationGPS.h>
#include <mrpt/obs/CObservationOdometry.h>

#include <algorithm>

#include "paloc/core/errors.h"
#include "paloc/frontends/tum_file.h"
#include "temp_dir.h"

namespace paloc {
namespace {

using namespace test::recorded;

// Each frame follows the IMU samples up to and including the first at or after its time, no others.
void expectOrder(const Output& output) {
  TimeNs last_imu = 0, before_last = 0;
  for (const FrontendEvent& event : output.events) {
    if (const auto* sample = std::get_if<ImuSample>(&event)) {
      EXPECT_GT(sample->t_ns, last_imu);
      before_last = last_imu;
      last_imu = sample->t_ns;
    } else {
      const TimeNs t = std::get<OdometryFrame>(event).t_ns;
      EXPECT_GE(last_imu, t);
      EXPECT_LT(before_last, t);
    }
  }
}

TEST(RecordedOdometry, FramesAtScanEndsAmongTheImuSamples) {
  const Output output = run(walk(5).inOrder());
  ASSERT_EQ(output.frames.size(), 5U);
  expectOrder(output);
  for (std::size_t i = 0; i < 5; ++i) {
    const OdometryFrame& frame = output.frames[i];
    EXPECT_EQ(frame.t_ns, kT0 + static_cast<TimeNs>(i + 1) * kScan);
    EXPECT_EQ(frame.continues, i > 0);
    EXPECT_LT(boxminus(fromMrpt(frame.T_odom_body), truth(frame.t_ns)).norm(), 1e-9);
    ASSERT_TRUE(frame.scan);
    EXPECT_EQ(frame.scan->start_ns, kT0 + static_cast<TimeNs>(i) * kScan);
    EXPECT_LT(test::worstOffWall(test::BoxRoom{}, truth(frame.t_ns), frame.scan->points_body),
              3e-3);
    EXPECT_TRUE(frame.scan->v_body_assumed) << "an estimator may know better";
  }
  EXPECT_TRUE(
      output.noted("LiDAR 'lidar' (CObservationLidarScan): points have times, ns after the "
                   "stamp, 100.0 ms a scan"));
  EXPECT_TRUE(output.unused.empty());
}

TEST(RecordedOdometry, ScansLoggedAfterTheirEndComeTheSame) {
  auto late = walk(5).inOrder();
  std::stable_sort(late.begin(), late.end(), [](const auto& a, const auto& b) {
    const auto arrival = [](const auto& o) {
      return fromMrptTime(o->timestamp) + (o->sensorLabel == "lidar" ? kScan + 30 * kMs : 0);
    };
    return arrival(a) < arrival(b);
  });
  const Output a = run(walk(5).inOrder()), b = run(late);
  expectOrder(b);
  ASSERT_EQ(a.frames.size(), b.frames.size());
  for (std::size_t i = 0; i < a.frames.size(); ++i) {
    const auto &p = a.frames[i].scan->points_body, &q = b.frames[i].scan->points_body;
    ASSERT_EQ(p.size(), q.size());
    for (std::size_t k = 0; k < p.size(); ++k) EXPECT_EQ(p[k].x, q[k].x);
  }
}

TEST(RecordedOdometry, MotionCovarianceFromSettingsOrStream) {
  FrontendSettings settings;
  const Output by_settings = run(walk(2).inOrder(), settings);
  const Pose motion = truth(kT0 + kScan).inverse() * truth(kT0 + 2 * kScan);
  const double way = motion.position.norm();
  EXPECT_NEAR(by_settings.frames[1].motion_covariance(0, 0),
              std::pow(settings.odometry_sigma_position_floor_m, 2) +
                  std::pow(settings.odometry_sigma_position_ratio * way, 2),
              1e-12);

  auto observations = walk(2).inOrder();
  for (auto& observation : observations) {
    if (auto pose = std::dynamic_pointer_cast<CObservationRobotPose>(observation)) {
      for (int i = 0; i < 6; ++i) pose->pose.cov(i, i) = i < 3 ? 4e-4 : 1e-6;
    }
  }
  const Output by_stream = run(observations);
  const Mat6& c = by_stream.frames[1].motion_covariance;
  // Two steps of the stream lie between the frames; a small part is the first step's turning.
  EXPECT_NEAR(c.diagonal().head(3).sum(), 3 * 2 * 4e-4, 1e-5);
  EXPECT_NEAR(c.diagonal().tail(3).sum(), 3 * 2 * 1e-6, 2e-7);
  EXPECT_LT((c - c.transpose()).norm(), 1e-15);
}

TEST(RecordedOdometry, GapInTheOdometryBreaksTheMotion) {
  Recording recording = Recording().imu(kT0 - 20 * kMs, kT0 + 21 * kScan).scans(20);
  recording.odometry(kT0 - 50 * kMs, kT0 + 5 * kScan).odometry(kT0 + 13 * kScan, kT0 + 21 * kScan);
  const Output output = run(recording.inOrder());
  ASSERT_EQ(output.frames.size(), 20U);
  for (std::size_t i = 0; i < 20; ++i) {
    // Ends 1..5 have the odometry, 6 is carried on, 7..12 have none, 13 starts anew.
    const std::size_t end = i + 1;
    EXPECT_EQ(output.frames[i].continues, (end > 1 && end <= 6) || end > 13) << end;
    EXPECT_TRUE(output.frames[i].scan);
  }
  EXPECT_TRUE(output.noted("the odometry pauses for more than 0.5 s 1 time, at most 0.800 s"));
  EXPECT_TRUE(output.noted("6 of 20 scans end where the odometry does not reach"));
  EXPECT_TRUE(output.noted("1 of 20 scans end up to 0.1 s after"));
}

TEST(RecordedOdometry, AJumpIsNoMotion) {
  auto observations = walk(6).inOrder();
  for (auto& observation : observations) {
    auto pose = std::dynamic_pointer_cast<CObservationRobotPose>(observation);
    if (pose && fromMrptTime(pose->timestamp) > kT0 + 3 * kScan) {
      pose->pose.mean.x_incr(100);
    }
  }
  const Output output = run(observations);
  const std::vector<bool> expected = {false, true, true, false, true, true};
  ASSERT_EQ(output.frames.size(), 6U);
  for (std::size_t i = 0; i < 6; ++i) EXPECT_EQ(output.frames[i].continues, expected[i]) << i;
  EXPECT_TRUE(output.noted("the odometry jumps 1 time"));
}

TEST(RecordedOdometry, TimeGoingBackwardsAndRepeatedStampsAreCounted) {
  auto observations = walk(3).inOrder();
  observations.push_back(imuAt(kT0));
  observations.push_back(poseAt(kT0));
  observations.push_back(scanAt(kT0));
  observations.push_back(scanAt(kT0 + 2 * kScan));
  observations.push_back(observations[observations.size() - 5]);
  const Output output = run(observations);
  EXPECT_EQ(output.frames.size(), 3U);
  EXPECT_EQ(output.count("imu", "time goes backwards"), 1U);
  EXPECT_EQ(output.count("odom", "time goes backwards") + output.count("odom", "repeated stamp") +
                output.count("imu", "repeated stamp"),
            2U);
  EXPECT_EQ(output.count("lidar", "time goes backwards"), 1U);
  EXPECT_EQ(output.count("lidar", "repeated stamp"), 1U);
  expectOrder(output);
}

TEST(RecordedOdometry, OneWrongStampDoesNotSpoilTheRest) {
  auto observations = walk(5).inOrder();
  const std::size_t at = observations.size() / 2;
  for (const TimeNs far : {3600 * kNsPerSecond}) {
    observations.insert(observations.begin() + static_cast<std::ptrdiff_t>(at), scanAt(kT0 + far));
    observations.insert(observations.begin() + static_cast<std::ptrdiff_t>(at), imuAt(kT0 + far));
    observations.insert(observations.begin() + static_cast<std::ptrdiff_t>(at), poseAt(kT0 + far));
  }
  const Output output = run(observations);
  EXPECT_EQ(output.frames.size(), 5U);
  for (const char* label : {"imu", "odom", "lidar"}) {
    EXPECT_EQ(output.count(label, "stamp a minute or more ahead"), 1U) << label;
  }
}

TEST(RecordedOdometry, APauseOfTheRecordingIsGoneOver) {
  Recording recording = walk(3);
  const TimeNs later = 600 * kNsPerSecond;
  recording.imu(kT0 + later, kT0 + later + 5 * kScan)
      .odometry(kT0 + later, kT0 + later + 5 * kScan);
  for (int i = 0; i < 4; ++i) recording.add(scanAt(kT0 + later + i * kScan));
  const Output output = run(recording.inOrder());
  EXPECT_EQ(output.frames.size(), 3U + 3U) << "all but the first scan after the pause";
  EXPECT_FALSE(output.frames[3].continues);
  EXPECT_TRUE(output.frames[4].continues);
}

TEST(RecordedOdometry, WithoutOdometryFramesComeForTheImu) {
  const Output output = run(Recording().imu(kT0 - 20 * kMs, kT0 + 16 * kScan).scans(15).inOrder());
  ASSERT_EQ(output.frames.size(), 15U);
  for (const OdometryFrame& frame : output.frames) {
    EXPECT_FALSE(frame.continues);
    EXPECT_TRUE(frame.scan);
    EXPECT_LT(boxminus(fromMrpt(frame.T_odom_body), Pose{}).norm(), 1e-15);
  }
  EXPECT_TRUE(output.noted("there is no odometry that can be used"));
}

TEST(RecordedOdometry, WithoutImuTheOdometryDeskews) {
  const Output output =
      run(Recording().odometry(kT0 - 50 * kMs, kT0 + 6 * kScan, 5 * kMs).scans(5).inOrder());
  ASSERT_EQ(output.frames.size(), 5U);
  EXPECT_TRUE(output.imu.empty());
  EXPECT_TRUE(output.frames[4].continues);
  const Scan& scan = *output.frames[2].scan;
  EXPECT_LT(test::worstOffWall(test::BoxRoom{}, truth(scan.end_ns), scan.points_body), 1e-3);
  EXPECT_FALSE(scan.v_body_assumed) << "the estimator can do no better";
  EXPECT_TRUE(output.noted("there is no IMU that can be used"));
}

TEST(RecordedOdometry, WithNeitherItSaysSo) {
  const Output output = run(Recording().scans(3).inOrder());
  ASSERT_EQ(output.frames.size(), 3U);
  EXPECT_TRUE(output.noted("neither IMU nor odometry"));
  EXPECT_EQ(output.count("lidar", "not deskewed: neither IMU nor odometry cover the scan"), 3U);
}

TEST(RecordedOdometry, ImuPauseIsNotIntegratedOver) {
  Recording recording = Recording().odometry(kT0 - 50 * kMs, kT0 + 21 * kScan).scans(20);
  recording.imu(kT0 - 20 * kMs, kT0 + 5 * kScan).imu(kT0 + 15 * kScan, kT0 + 21 * kScan);
  const Output output = run(recording.inOrder());
  EXPECT_EQ(output.frames.size(), 20U);
  EXPECT_TRUE(
      output.noted("the IMU pauses for more than 0.05 s 1 time, at most 1.000 s, at t = 5.500 s"));
  EXPECT_TRUE(output.noted("10 of 20 scans are deskewed by the odometry alone"));
}

TEST(RecordedOdometry, WrongLabelsListThoseThatExist) {
  FrontendSettings settings;
  settings.lidar_label = "velodyne";
  settings.imu_label = "xsens";
  settings.odometry_label = "wheel";
  const Output output = run(walk(3).inOrder(), settings);
  EXPECT_TRUE(output.events.empty());
  EXPECT_TRUE(
      output.hasProblem("there is no LiDAR with the label 'velodyne'; there are: 'lidar' "
                        "(CObservationLidarScan)"));
  EXPECT_TRUE(output.hasProblem("there is no IMU with the label 'xsens'; there are: 'imu'"));
  EXPECT_TRUE(output.hasProblem("there is no odometry with the label 'wheel'; there are: 'odom'"));
  EXPECT_EQ(output.count("lidar", "another LiDAR is used"), 3U);
}

TEST(RecordedOdometry, TheFirstOfSeveralLidarsIsUsedUnlessOneIsChosen) {
  Recording recording = walk(3);
  for (int i = 0; i < 3; ++i) recording.add(scanAt(kT0 + i * kScan + kMs, "second"));
  const Output first = run(recording.inOrder());
  EXPECT_EQ(first.frames.size(), 3U);
  EXPECT_EQ(first.count("second", "another LiDAR is used"), 3U);
  EXPECT_TRUE(first.noted("there are several LiDAR streams, of which the first is used"));
  FrontendSettings settings;
  settings.lidar_label = "second";
  const Output second = run(recording.inOrder(), settings);
  EXPECT_EQ(second.count("lidar", "another LiDAR is used"), 3U);
  EXPECT_EQ(second.frames.at(0).t_ns, kT0 + kMs + kScan);
}

TEST(RecordedOdometry, BadObservationsAreCountedByReason) {
  Recording recording = walk(3);
  auto nan_imu = std::dynamic_pointer_cast<CObservationIMU>(imuAt(kT0 + 2 * kMs));
  nan_imu->set(mrpt::obs::IMU_X_ACC, std::nan(""));
  auto half_imu = CObservationIMU::Create();
  half_imu->sensorLabel = "imu";
  half_imu->timestamp = toMrptTime(kT0 + 3 * kMs);
  auto lever_imu = std::dynamic_pointer_cast<CObservationIMU>(imuAt(kT0 + 4 * kMs));
  lever_imu->sensorPose.x(0.1);
  auto nan_pose = poseAt(kT0 + kMs);
  nan_pose->pose.mean.y(std::nan(""));
  auto empty = obs::CObservationLidarScan::Create();
  empty->sensorLabel = "lidar";
  empty->timestamp = toMrptTime(kT0 + 3 * kScan);
  auto gps = mrpt::obs::CObservationGPS::Create();
  gps->sensorLabel = "gps";
  gps->timestamp = toMrptTime(kT0);
  for (const CObservation::Ptr& o :
       std::vector<CObservation::Ptr>{nan_imu, half_imu, lever_imu, nan_pose, empty, gps}) {
    recording.add(o);
  }
  const Output output = run(recording.inOrder());
  EXPECT_EQ(output.count("imu", "not finite"), 1U);
  EXPECT_EQ(output.count("imu", "no accelerometer or gyroscope values"), 1U);
  EXPECT_EQ(output.count("imu", "IMU away from the body's origin (the body frame is the IMU's)"),
            1U);
  EXPECT_EQ(output.count("odom", "not finite"), 1U);
  EXPECT_EQ(output.count("gps", "not a LiDAR, IMU or odometry"), 1U);
  // It ends when the third scan does: of no use.
  EXPECT_EQ(output.count("lidar", "ends no later than the scan before it"), 1U);
  EXPECT_EQ(output.frames.size(), 3U);
}

TEST(RecordedOdometry, AScanWithoutPointsIsAFrameWithoutAScan) {
  Recording recording = walk(3);
  auto empty = obs::CObservationLidarScan::Create();
  empty->sensorLabel = "lidar";
  empty->timestamp = toMrptTime(kT0 + 3 * kScan + 10 * kMs);
  recording.add(empty);
  const Output output = run(recording.inOrder());
  ASSERT_EQ(output.frames.size(), 4U);
  EXPECT_FALSE(output.frames[3].scan);
  EXPECT_TRUE(output.frames[3].continues);
  EXPECT_EQ(output.count("lidar", "scan without a point"), 1U);
}

TEST(RecordedOdometry, OdometryFileReplacesTheRecordings) {
  const test::TempDir dir;
  std::vector<StampedPose> poses;
  for (int i = 0; i <= 3; ++i) {
    poses.push_back({kT0 + i * kScan, Pose{Vec3(i, 0, 0), Mat3::Identity()}});
  }
  FrontendSettings settings;
  settings.odometry_file = (dir.path() / "odometry.tum").string();
  writeTum(settings.odometry_file, poses);
  const Output output = run(walk(3).inOrder(), settings);
  ASSERT_EQ(output.frames.size(), 3U);
  for (int i = 0; i < 3; ++i) {
    EXPECT_NEAR(output.frames[static_cast<std::size_t>(i)].T_odom_body.x(), i + 1, 1e-12);
  }
  EXPECT_GT(output.count("odom", "an odometry file is used instead"), 0U);
  settings.odometry_file = (dir.path() / "none.tum").string();
  EXPECT_THROW(OdometryFrontend::create("recorded", settings), IoError);
}

TEST(RecordedOdometry, PlanarOdometry) {
  Recording recording = Recording().imu(kT0 - 20 * kMs, kT0 + 4 * kScan).scans(3);
  for (TimeNs t = kT0 - 50 * kMs; t <= kT0 + 4 * kScan; t += 50 * kMs) {
    auto odometry = mrpt::obs::CObservationOdometry::Create();
    odometry->timestamp = toMrptTime(t);
    odometry->sensorLabel = "wheels";
    odometry->odometry = mrpt::poses::CPose2D(1, 2, 0.5 * static_cast<double>(t - kT0) * 1e-9);
    recording.add(odometry);
  }
  const Output output = run(recording.inOrder());
  ASSERT_EQ(output.frames.size(), 3U);
  EXPECT_NEAR(output.frames[0].T_odom_body.yaw(), 0.05, 1e-9);
  EXPECT_TRUE(output.frames[1].continues);
}

TEST(RecordedOdometry, SensorPoseOfTheStreamIsTakenOff) {
  auto observations = walk(3).inOrder();
  const Pose T_body_sensor{Vec3(0.3, 0.1, -0.2), so3::exp(Vec3(0.1, 0.2, 0.3))};
  for (auto& observation : observations) {
    if (auto pose = std::dynamic_pointer_cast<CObservationRobotPose>(observation)) {
      pose->pose.mean = toMrpt(fromMrpt(pose->pose.mean) * T_body_sensor);
      pose->sensorPose = toMrpt(T_body_sensor);
    }
  }
  const Output output = run(observations);
  EXPECT_LT(boxminus(fromMrpt(output.frames[1].T_odom_body), truth(output.frames[1].t_ns)).norm(),
            1e-9);
}

TEST(OdometryFrontend, RegistryNamesWhatExists) {
  try {
    OdometryFrontend::create("nonsense", {});
    FAIL();
  } catch (const ConfigError& e) {
    EXPECT_NE(std::string(e.what()).find("'recorded'"), std::string::npos);
  }
  OdometryFrontend::registerFrontend("mine", [](const FrontendSettings& settings) {
    return OdometryFrontend::create("recorded", settings);
  });
  EXPECT_TRUE(OdometryFrontend::create("mine", {}));
  EXPECT_THROW(OdometryFrontend::registerFrontend("recorded", nullptr), ConfigError);
}

}  // namespace
}  // namespace paloc

#include <gtest/gtest.h>
#include <mrpt/obs/CObservationRobotPose.h>

#include <map>

#include "paloc/core/errors.h"
#include "paloc/core/mrpt_pose.h"
#include "paloc/frontends/CObservationLidarScan.h"
#include "paloc/frontends/mrpt_time.h"
#include "paloc/frontends/odometry_reader.h"
#include "paloc/tools/export_rosbag.h"
#include "paloc/tools/import_rosbag.h"
#include "paloc/tools/motion_observations.h"
#include "temp_dir.h"

namespace paloc {
namespace {

constexpr TimeNs kStart = 1700000000'123456700;

class Rosbag : public testing::Test {
 protected:
  void SetUp() override {
    if (!builtWithRosbag()) GTEST_SKIP() << "built without librosbag-storage";
    RawlogWriter writer(folder_ / "a.rawlog");
    for (int i = 0; i < 5; ++i) {
      const TimeNs t_ns = kStart + i * 100'000'000;
      scan_.timestamp = toMrptTime(t_ns);
      scan_.sensorLabel = "top lidar";
      scan_.sensorPoseOnRobot = mrpt::poses::CPose3D(0.1, 0.2, 0.3, 0.4, 0.5, 0.6);
      scan_.x = {1.1F, 2.2F}, scan_.y = {-3.3F, 4.4F}, scan_.z = {0.5F, 0.6F};
      scan_.dt_ns = {17, 99'000'001};
      scan_.intensity = {40, 3000};
      scan_.ring = {3, 127};
      Mat6 a = Mat6::Identity() * 0.01;
      a(0, 1) = a(1, 0) = 0.002;
      a(3, 5) = a(5, 3) = -0.003;
      pose_.timestamp = scan_.timestamp;
      pose_.pose = toMrpt(fromMrpt(mrpt::poses::CPose3D(i, 2, 3, 0.7, 0.2, -0.4)), a);
      writer.write(pose_);
      writer.write(imuObservation({t_ns, Vec3(0.1, 0.2, 9.8), Vec3(1, 2, 3)}, "imu"));
      writer.write(scan_);
    }
    writer.close();
  }

  ExportSummary exportAs(RosCloudLayout layout) {
    return exportRosbag({folder_ / "a.rawlog", folder_ / "a.bag", layout, true}, [](double) {});
  }

  ImportRosbagSettings settings(const std::string& bag = "a.bag") {
    ImportRosbagSettings s;
    s.bags = {folder_ / bag};
    s.output.file = folder_ / "b.rawlog";
    s.output.overwrite = true;
    return s;
  }

  std::map<std::string, mrpt::obs::CObservation::Ptr> lastOfEach() {
    RawlogStream stream(folder_ / "b.rawlog");
    std::map<std::string, mrpt::obs::CObservation::Ptr> last;
    while (auto o = stream.next()) last[o->sensorLabel] = o;
    return last;
  }

  test::TempDir folder_;
  obs::CObservationLidarScan scan_;
  mrpt::obs::CObservationRobotPose pose_;
};

TEST_F(Rosbag, RoundTripKeepsEveryBitOfAScan) {
  EXPECT_TRUE(exportAs(RosCloudLayout::kOuster).complete());
  const ImportSummary summary = importRosbag(settings(), [](double) {});
  EXPECT_TRUE(summary.complete());
  EXPECT_EQ(summary.scans, 5U);
  EXPECT_EQ(summary.imu_samples, 5U);
  const auto last = lastOfEach();
  const auto scan = std::dynamic_pointer_cast<obs::CObservationLidarScan>(last.at("lidar"));
  ASSERT_TRUE(scan);
  EXPECT_EQ(scan->timestamp, scan_.timestamp);
  EXPECT_EQ(scan->x, scan_.x);
  EXPECT_EQ(scan->y, scan_.y);
  EXPECT_EQ(scan->z, scan_.z);
  EXPECT_EQ(scan->dt_ns, scan_.dt_ns);
  EXPECT_EQ(scan->intensity, scan_.intensity);
  EXPECT_EQ(scan->ring, scan_.ring);
  EXPECT_FALSE(scan->deskewed);
  const Pose T = fromMrpt(scan->sensorPoseOnRobot), was = fromMrpt(scan_.sensorPoseOnRobot);
  EXPECT_NEAR((T.position - was.position).norm() + (T.rotation - was.rotation).norm(), 0, 1e-12);
  std::string refusal;
  const auto pose = decodeOdometry(*last.at("odometry"), refusal);
  const auto pose_was = decodeOdometry(pose_, refusal);
  ASSERT_TRUE(pose && pose->step_covariance) << refusal;
  EXPECT_EQ(pose->t_ns, pose_was->t_ns);
  EXPECT_NEAR((*pose->step_covariance - *pose_was->step_covariance).norm(), 0, 1e-12);
  EXPECT_NEAR((pose->T_odom_body.rotation - pose_was->T_odom_body.rotation).norm(), 0, 1e-12);
}

TEST_F(Rosbag, VelodyneLayoutKeepsTimesToTheFloat) {
  exportAs(RosCloudLayout::kVelodyne);
  importRosbag(settings(), [](double) {});
  const auto scan = std::dynamic_pointer_cast<obs::CObservationLidarScan>(lastOfEach().at("lidar"));
  ASSERT_TRUE(scan);
  ASSERT_EQ(scan->dt_ns.size(), 2U);
  EXPECT_NEAR(scan->dt_ns[1], scan_.dt_ns[1], 10);
}

TEST_F(Rosbag, GivenTwiceCountsWhatIsRepeated) {
  exportAs(RosCloudLayout::kOuster);
  auto twice = settings();
  twice.bags.push_back(twice.bags.front());
  const ImportSummary summary = importRosbag(twice, [](double) {});
  EXPECT_EQ(summary.scans, 5U);
  EXPECT_EQ(summary.not_used.at("scans with the stamp of another"), 5U);
  EXPECT_EQ(summary.not_used.at("IMU samples with the stamp of another"), 5U);
}

TEST_F(Rosbag, TopicsAreNamedWhereOneIsWrong) {
  exportAs(RosCloudLayout::kOuster);
  auto wrong = settings();
  wrong.lidar = "/nowhere";
  try {
    importRosbag(wrong, [](double) {});
    FAIL();
  } catch (const UsageError& e) {
    EXPECT_NE(std::string(e.what()).find("/top_lidar (sensor_msgs/PointCloud2, 5)"),
              std::string::npos)
        << e.what();
  }
  auto none = settings();
  none.imu = none.odometry = "none";
  EXPECT_EQ(importRosbag(none, [](double) {}).imu_samples, 0U);
}

TEST_F(Rosbag, WhatIsNoWholeBagIsRefusedInOneSentence) {
  exportAs(RosCloudLayout::kOuster);
  const std::string bytes = test::readFile(folder_ / "a.bag");
  std::string unindexed = bytes;
  unindexed.replace(unindexed.find("index_pos=") + 10, 8, 8, '\0');
  folder_.write("unindexed.bag", unindexed);
  folder_.write("cut.bag", bytes.substr(0, bytes.size() - 100));
  folder_.write("text.bag", "hello\n");
  folder_.write("empty.bag", "");
  for (const char* bag : {"unindexed.bag", "cut.bag", "text.bag", "empty.bag", "missing.bag"}) {
    try {
      importRosbag(settings(bag), [](double) {});
      ADD_FAILURE() << bag << " was read";
    } catch (const IoError& e) {
      EXPECT_NE(std::string(e.what()).find(bag), std::string::npos) << e.what();
      EXPECT_EQ(std::string(e.what()).find('\n'), std::string::npos) << e.what();
    }
  }
}

TEST_F(Rosbag, FullDiskIsAnError) {
  EXPECT_THROW(exportRosbag({folder_ / "a.rawlog", "/dev/full", RosCloudLayout::kOuster, true},
                            [](double) {}),
               IoError);
}

}  // namespace
}  // namespace paloc

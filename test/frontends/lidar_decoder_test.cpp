#include "paloc/frontends/lidar_decoder.h"

#include <gtest/gtest.h>
#include <mrpt/maps/CPointsMapXYZI.h>
#include <mrpt/maps/CSimplePointsMap.h>
#include <mrpt/obs/CObservation3DRangeScan.h>
#include <mrpt/obs/CObservationGPS.h>
#include <mrpt/obs/CObservationPointCloud.h>
#include <mrpt/obs/CObservationRotatingScan.h>
#include <mrpt/obs/CObservationVelodyneScan.h>

#include <cmath>
#include <limits>

#include "paloc/frontends/CObservationLidarScan.h"
#include "paloc/frontends/mrpt_time.h"

namespace paloc {
namespace {

constexpr TimeNs kStamp = 1'645'002'364'537'699'900;
constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

LidarFrame decoded(const mrpt::obs::CObservation& observation, LidarColumns columns = {}) {
  std::string refusal;
  auto frame = decodeLidar(observation, columns, refusal);
  if (!frame) {
    ADD_FAILURE() << refusal;
    return {};
  }
  return *frame;
}

std::string refusalOf(const mrpt::obs::CObservation& observation) {
  std::string refusal;
  return decodeLidar(observation, {}, refusal) ? "" : refusal;
}

obs::CObservationLidarScan smallScan() {
  obs::CObservationLidarScan scan;
  scan.timestamp = toMrptTime(kStamp);
  scan.sensorLabel = "os1";
  scan.sensorPoseOnRobot = mrpt::poses::CPose3D(1, 2, 3, 0, 0, 0);
  scan.x = {1, 0, kNan, 4, 1e30F, 6};
  scan.y = {1, 0, 1, 5, 1e30F, 7};
  scan.z = {1, 0, 1, 6, 1e30F, 8};
  scan.dt_ns = {0, 10, 20, 30, 40, 50};
  scan.intensity = {10, 11, 12, 13, 14, 15};
  scan.ring = {0, 1, 2, 3, 4, 5};
  return scan;
}

TEST(LidarScan, InvalidPointsGoWithTheirColumns) {
  const LidarFrame frame = decoded(smallScan(), {true, true});
  EXPECT_EQ(frame.stamp_ns, kStamp);
  EXPECT_EQ(frame.label, "os1");
  EXPECT_EQ(frame.class_name, "CObservationLidarScan");
  ASSERT_EQ(frame.points_lidar.size(), 3U);
  EXPECT_EQ(frame.invalid_points, 3U);  // zero, NaN, and one too far for a float's square
  EXPECT_EQ(frame.points_lidar[1].y, 5);
  EXPECT_EQ(frame.dt_ns, (std::vector<std::uint32_t>{0, 30, 50}));
  EXPECT_EQ(frame.intensity, (std::vector<float>{10, 13, 15}));
  EXPECT_EQ(frame.ring, (std::vector<std::uint16_t>{0, 3, 5}));
  EXPECT_EQ(frame.duration_ns, 50) << "no duration told: that of the latest point";
  EXPECT_EQ(frame.T_body_lidar.position, Vec3(1, 2, 3));
  EXPECT_FALSE(frame.deskewed);
  EXPECT_EQ(frame.time_policy, "points have times, ns after the stamp");
}

TEST(LidarScan, RecycledMemoryChangesNothing) {
  std::string refusal;
  obs::CObservationLidarScan other = smallScan();
  other.dt_ns.clear();
  other.duration_ns = 7;
  auto frame = decodeLidar(other, {}, refusal, decoded(smallScan(), {true, true}));
  ASSERT_TRUE(frame);
  EXPECT_EQ(frame->points_lidar.size(), 3U);
  EXPECT_TRUE(frame->dt_ns.empty());
  EXPECT_TRUE(frame->intensity.empty());
  EXPECT_EQ(frame->duration_ns, 7);
  EXPECT_EQ(frame->time_policy, "points have no times");
}

TEST(LidarScan, DeskewedScansNeedNoTimes) {
  obs::CObservationLidarScan scan = smallScan();
  scan.deskewed = true;
  scan.duration_ns = 100;
  const LidarFrame frame = decoded(scan);
  EXPECT_TRUE(frame.deskewed);
  EXPECT_TRUE(frame.dt_ns.empty());
  EXPECT_EQ(frame.endNs(), kStamp + 100);
}

TEST(LidarScan, RefusesWhatDoesNotFit) {
  obs::CObservationLidarScan scan = smallScan();
  scan.dt_ns.pop_back();
  EXPECT_EQ(refusalOf(scan), "its columns differ in length");
  scan = smallScan();
  scan.sensorPoseOnRobot.x(std::nan(""));
  EXPECT_EQ(refusalOf(scan), "its sensor pose is not finite");
  const mrpt::obs::CObservationGPS gps;
  EXPECT_FALSE(isLidar(gps));
  EXPECT_EQ(refusalOf(gps), "not a LiDAR scan");
}

TEST(PointCloud, TakenAsDeskewed) {
  auto cloud = mrpt::maps::CPointsMapXYZI::Create();
  cloud->insertPoint(1, 2, 3);
  cloud->insertPoint(kNan, 2, 3);
  cloud->insertPoint(4, 5, 6);
  cloud->setPointIntensity(2, 0.5F);
  mrpt::obs::CObservationPointCloud scan;
  scan.timestamp = toMrptTime(kStamp);
  scan.pointcloud = cloud;
  const LidarFrame frame = decoded(scan, {true, true});
  ASSERT_EQ(frame.points_lidar.size(), 2U);
  EXPECT_EQ(frame.invalid_points, 1U);
  EXPECT_EQ(frame.intensity.at(1), 0.5F);
  EXPECT_TRUE(frame.deskewed);
  EXPECT_EQ(frame.duration_ns, 0);
  EXPECT_NE(frame.time_policy.find("taken as deskewed"), std::string::npos);
}

TEST(PointCloud, MissingExternalFileIsOneClause) {
  mrpt::obs::CObservationPointCloud scan;
  scan.setAsExternalStorage(
      "/nonexistent/cloud.bin",
      mrpt::obs::CObservationPointCloud::ExternalStorageFormat::MRPT_Serialization);
  const std::string refusal = refusalOf(scan);
  EXPECT_EQ(refusal.find("cannot be read: "), 0U) << refusal;
  EXPECT_EQ(refusal.find('\n'), std::string::npos);
  mrpt::obs::CObservationPointCloud empty;
  EXPECT_EQ(refusalOf(empty), "it holds no cloud");
}

TEST(VelodyneCloud, AbsoluteTimesBecomeDifferences) {
  mrpt::obs::CObservationVelodyneScan scan;
  scan.timestamp = toMrptTime(kStamp);
  scan.point_cloud.x = {1, 0, 3};
  scan.point_cloud.y = {1, 0, 3};
  scan.point_cloud.z = {1, 0, 3};
  scan.point_cloud.intensity = {1, 2, 3};
  scan.point_cloud.laser_id = {5, 6, 7};
  for (const TimeNs dt : {0, 50'000, 99'000'000}) {
    scan.point_cloud.timestamp.push_back(toMrptTime(kStamp + dt));
  }
  const LidarFrame frame = decoded(scan, {true, true});
  EXPECT_EQ(frame.dt_ns, (std::vector<std::uint32_t>{0, 99'000'000}));
  EXPECT_EQ(frame.ring, (std::vector<std::uint16_t>{5, 7}));
  EXPECT_EQ(frame.duration_ns, 99'000'000);
  EXPECT_EQ(frame.stamp_ns, kStamp);

  scan.timestamp = toMrptTime(kStamp + 99'000'000);  // a stamp of the last point
  const LidarFrame late = decoded(scan);
  EXPECT_EQ(late.stamp_ns, kStamp);
  EXPECT_EQ(late.dt_ns, frame.dt_ns);
  EXPECT_NE(late.time_policy.find("before the stamp"), std::string::npos);

  scan.timestamp = toMrptTime(kStamp - 10 * kNsPerSecond);
  EXPECT_NE(refusalOf(scan).find("more than 4 s"), std::string::npos);
  scan.point_cloud.timestamp.clear();
  EXPECT_TRUE(decoded(scan).deskewed);
}

TEST(RotatingScan, ColumnsHaveTheirTimes) {
  mrpt::obs::CObservationRotatingScan scan;
  scan.timestamp = toMrptTime(kStamp);
  scan.rowCount = 1;
  scan.columnCount = 5;
  scan.rangeImage.setZero(1, 5);
  scan.rangeResolution = 0.01;
  scan.startAzimuth = 0;
  scan.azimuthSpan = std::acos(-1.0);
  scan.sweepDuration = 0.04;
  scan.rangeImage(0, 0) = 100;
  scan.rangeImage(0, 2) = 200;
  const LidarFrame frame = decoded(scan);
  ASSERT_EQ(frame.points_lidar.size(), 2U);
  EXPECT_EQ(frame.invalid_points, 3U);
  EXPECT_NEAR(frame.points_lidar[0].x, 1, 1e-6);
  EXPECT_NEAR(frame.points_lidar[1].x, 0, 1e-6);
  EXPECT_NEAR(frame.points_lidar[1].y, 2, 1e-6);  // counter-clockwise
  EXPECT_EQ(frame.dt_ns, (std::vector<std::uint32_t>{0, 20'000'000}));
  EXPECT_EQ(frame.duration_ns, 40'000'000);

  scan.sweepDuration = 0;
  EXPECT_TRUE(decoded(scan).deskewed);
  scan.rangeImage.setZero(2, 5);
  EXPECT_NE(refusalOf(scan).find("size"), std::string::npos);
  scan.rowCount = 2;
  scan.lidarModel = "OS1";
  EXPECT_NE(refusalOf(scan).find("no elevation angles, and those of 'OS1'"), std::string::npos);
}

TEST(RangeCamera, PointsOrRangeImage) {
  mrpt::obs::CObservation3DRangeScan scan;
  scan.timestamp = toMrptTime(kStamp);
  EXPECT_EQ(refusalOf(scan), "it holds neither points nor a range image");
  scan.hasRangeImage = true;
  scan.rangeImage.setZero(2, 2);
  scan.rangeImage(1, 0) = 2000;
  scan.rangeUnits = 0.001F;
  scan.range_is_depth = true;
  scan.cameraParams.setIntrinsicParamsFromValues(2, 4, 1, 0.5);
  LidarFrame frame = decoded(scan);
  ASSERT_EQ(frame.points_lidar.size(), 1U);
  EXPECT_EQ(frame.invalid_points, 3U);
  EXPECT_NEAR(frame.points_lidar[0].x, 2.0, 1e-6);
  EXPECT_NEAR(frame.points_lidar[0].y, 1.0, 1e-6);    // (1 - 0) / 2 * 2
  EXPECT_NEAR(frame.points_lidar[0].z, -0.25, 1e-6);  // (0.5 - 1) / 4 * 2
  scan.hasPoints3D = true;
  scan.points3D_x = {1, kNan};
  scan.points3D_y = {2, 2};
  scan.points3D_z = {3, 3};
  frame = decoded(scan);
  EXPECT_EQ(frame.points_lidar.size(), 1U);
  EXPECT_TRUE(frame.deskewed);
}

}  // namespace
}  // namespace paloc

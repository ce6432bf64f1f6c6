#include <gtest/gtest.h>
#include <mrpt/obs/CObservationIMU.h>
#include <mrpt/obs/CObservationRobotPose.h>

#include <cmath>
#include <cstring>
#include <numbers>

#include "paloc/core/errors.h"
#include "paloc/frontends/CObservationLidarScan.h"
#include "paloc/frontends/mrpt_time.h"
#include "paloc/tools/import_clouds.h"
#include "paloc/tools/import_kitti.h"
#include "paloc/tools/imu_csv.h"
#include "paloc/tools/parse_pose.h"
#include "paloc/tools/recording_info.h"
#include "temp_dir.h"

namespace paloc {
namespace {

using obs::CObservationLidarScan;

constexpr TimeNs kStart = 1645002364'000000000;

// Ten scans a second, each spanning 0.09 s, as the field of one point-time convention.
std::vector<PointTimeSample> samples(double unit_ns, bool integer, TimeReference reference,
                                     TimeNs start = kStart) {
  std::vector<PointTimeSample> result;
  for (int i = 0; i < 5; ++i) {
    const TimeNs stamp = start + i * 100'000'000;
    double low = 0, high = 0.09e9;
    if (reference == TimeReference::kEnd) low = -0.09e9, high = 0;
    if (reference == TimeReference::kAbsolute) {
      low = static_cast<double>(stamp);
      high = low + 0.09e9;
    }
    result.push_back({stamp, low / unit_ns, high / unit_ns, "t", integer});
  }
  return result;
}

TEST(PointTimes, AreToldFromTheValues) {
  const std::pair<TimeUnit, double> units[] = {{TimeUnit::kSeconds, 1e9},
                                               {TimeUnit::kMilliseconds, 1e6},
                                               {TimeUnit::kMicroseconds, 1e3},
                                               {TimeUnit::kNanoseconds, 1}};
  for (const auto& [unit, unit_ns] : units) {
    for (const auto reference :
         {TimeReference::kStamp, TimeReference::kAbsolute, TimeReference::kEnd}) {
      for (const TimeNs start : {kStart, TimeNs{400'143'000}, TimeNs{0}}) {
        const auto rule = decidePointTimes(samples(unit_ns, false, reference, start), 0.1, {}, {});
        EXPECT_EQ(rule.unit, unit) << rule.sentence;
        EXPECT_EQ(rule.reference, reference) << rule.sentence;
      }
    }
  }
}

TEST(PointTimes, WhatIsStatedIsNotDecidedAndNonsenseIsRefused) {
  const auto ns = samples(1, true, TimeReference::kStamp);
  const auto rule = decidePointTimes(ns, 0.1, TimeUnit::kMicroseconds, TimeReference::kEnd);
  EXPECT_EQ(rule.unit, TimeUnit::kMicroseconds);
  EXPECT_EQ(rule.reference, TimeReference::kEnd);
  auto far = samples(1e9, false, TimeReference::kAbsolute);
  for (auto& s : far) s.stamp_ns -= 3600 * kNsPerSecond;  // clocks an hour apart
  EXPECT_THROW(decidePointTimes(far, 0.1, {}, {}), IoError);
  auto still = ns;
  for (auto& s : still) s.max = s.min;
  EXPECT_THROW(decidePointTimes(still, 0.1, {}, {}), IoError);
}

TEST(PointTimes, AreReadToTheNanosecond) {
  const PointTimeRule after{TimeUnit::kMicroseconds, TimeReference::kStamp, ""};
  const auto times = readPointTimes(after, {0, 1.5, NAN, 99}, kStart, {});
  EXPECT_EQ(times, (std::vector<TimeNs>{kStart, kStart + 1500, kNoTime, kStart + 99'000}));
  const PointTimeRule end{TimeUnit::kSeconds, TimeReference::kEnd, ""};
  EXPECT_EQ(readPointTimes(end, {-0.1, 0}, kStart, {}),
            (std::vector<TimeNs>{kStart, kStart + 100'000'000}));
  EXPECT_EQ(readPointTimes(end, {-0.1, 0}, kStart, kStart + 110'000'000),
            (std::vector<TimeNs>{kStart + 10'000'000, kStart + 110'000'000}));
}

std::string asciiPcd(const std::string& more_fields, const std::string& more_types,
                     const std::vector<std::string>& rows) {
  const std::string n = std::to_string(rows.size());
  std::string sizes = "4 4 4", counts = "1 1 1";
  for (const char c : more_types) {
    if (c == ' ') continue;
    sizes += " 8";
    counts += " 1";
  }
  std::string bytes = "VERSION 0.7\nFIELDS x y z " + more_fields + "\nSIZE " + sizes +
                      "\nTYPE F F F " + more_types + "\nCOUNT " + counts + "\nWIDTH " + n +
                      "\nHEIGHT 1\nPOINTS " + n + "\nDATA ascii\n";
  for (const auto& row : rows) bytes += row + '\n';
  return bytes;
}

std::vector<mrpt::obs::CObservation::Ptr> readAll(const std::filesystem::path& file) {
  RawlogStream stream(file);
  std::vector<mrpt::obs::CObservation::Ptr> all;
  while (auto o = stream.next()) all.push_back(o);
  EXPECT_EQ(stream.end(), RawlogStream::End::kClean) << stream.error();
  return all;
}

ImportCloudsSettings cloudSettings(const test::TempDir& folder) {
  ImportCloudsSettings settings;
  settings.folder = folder / "scans";
  settings.times_file = folder / "times.txt";
  settings.output.file = folder / "log.rawlog";
  settings.scans.T_body_lidar = parsePose("1,2,3,90,0,0", "--T-body-lidar");
  return settings;
}

TEST(ImportClouds, WritesEverythingInOrderOfTimeAndCountsTheRest) {
  const test::TempDir folder;
  for (int i = 0; i < 3; ++i) {
    folder.write("scans/" + std::to_string(i) + ".pcd",
                 asciiPcd("t ring intensity", "U U F",
                          {"1 0 0 0 5 0.2", "2 0 0 90000000 6 1.0", "nan 0 0 5 5 0"}));
  }
  folder.write("scans/3.pcd", "# .PCD v0.7\nbroken");
  folder.write("scans/unlisted.ply", "ply\n");
  folder.write("scans/readme.txt", "no cloud");
  folder.write("times.txt",
               "# name first\n2.pcd 100.2\n0.pcd 100.000000123\n1.pcd 100.1\n1.pcd 100.1\n"
               "3.pcd 100.3\n4.pcd 100.4\n");
  folder.write("odometry.tum", "100.1 1 2 3 0 0 0 1\n100.05 0 0 0 0 0 0 1\n");
  folder.write("imu.csv",
               "wx_radps,t_s,ax_mps2,ay_mps2,az_mps2,wy_radps,wz_radps,temperature\n"
               "1,100.1,4,5,6,2,3,20\n1,100.15,4,5,6,2,nan,20\n1,100.1,4,5,6,2,3,20\n");
  auto settings = cloudSettings(folder);
  settings.odometry_file = folder / "odometry.tum";
  settings.imu_file = folder / "imu.csv";
  const ImportSummary summary = importClouds(settings, [](double) {});
  EXPECT_FALSE(summary.complete());
  EXPECT_EQ(summary.not_used.at("scans listed twice"), 1U);
  EXPECT_EQ(summary.not_used.at("scans listed, but not there"), 1U);
  EXPECT_EQ(summary.not_used.at("scans that cannot be read"), 1U);
  EXPECT_EQ(summary.not_used.at("clouds without a time"), 1U);
  EXPECT_EQ(summary.not_used.at("IMU samples that are not finite"), 1U);
  EXPECT_EQ(summary.not_used.at("IMU samples with the stamp of another"), 1U);
  EXPECT_EQ(summary.noticed.at("points that are not finite (left out)"), 3U);
  EXPECT_EQ(summary.noticed.at("scan stamps going backwards (put in order)"), 1U);
  EXPECT_EQ(summary.noticed.at("odometry poses that go back in time (put in order)"), 1U);
  EXPECT_EQ(summary.scans, 3U);

  const auto all = readAll(settings.output.file);
  ASSERT_EQ(all.size(), 6U);
  for (std::size_t i = 1; i < all.size(); ++i) EXPECT_LE(all[i - 1]->timestamp, all[i]->timestamp);
  const auto scan = std::dynamic_pointer_cast<CObservationLidarScan>(all[0]);
  ASSERT_TRUE(scan);
  EXPECT_EQ(fromMrptTime(scan->timestamp), 100'000'000'100);  // MRPT's tick, downwards
  EXPECT_EQ(scan->dt_ns, (std::vector<std::uint32_t>{23, 90'000'023}));
  EXPECT_EQ(scan->duration_ns, 90'000'023U);
  EXPECT_EQ(scan->intensity, (std::vector<std::uint16_t>{51, 255}));
  EXPECT_EQ(scan->ring, (std::vector<std::uint16_t>{5, 6}));
  EXPECT_FALSE(scan->deskewed);
  EXPECT_NEAR(scan->sensorPoseOnRobot.yaw(), std::numbers::pi / 2, 1e-12);
  const auto imu = std::dynamic_pointer_cast<mrpt::obs::CObservationIMU>(all[2]);
  ASSERT_TRUE(imu);
  EXPECT_EQ(imu->get(mrpt::obs::IMU_WX), 1);
  EXPECT_EQ(imu->get(mrpt::obs::IMU_WZ), 3);
  EXPECT_EQ(imu->get(mrpt::obs::IMU_Z_ACC), 6);
  const auto pose = std::dynamic_pointer_cast<mrpt::obs::CObservationRobotPose>(all[3]);
  ASSERT_TRUE(pose);
  EXPECT_EQ(pose->pose.mean.y(), 2);
  EXPECT_THROW(importClouds(settings, [](double) {}), UsageError);  // it exists
}

TEST(ImportClouds, ScansWithoutTimesAreDeskewedUnlessStated) {
  const test::TempDir folder;
  folder.write("scans/0.pcd", asciiPcd("", "", {"1 0 0"}));
  folder.write("times.txt", "0.pcd 100.0\n");
  auto settings = cloudSettings(folder);
  settings.output.overwrite = true;
  const auto deskewed = [&] {
    EXPECT_TRUE(importClouds(settings, [](double) {}).complete());
    return std::dynamic_pointer_cast<CObservationLidarScan>(readAll(settings.output.file)[0])
        ->deskewed;
  };
  EXPECT_TRUE(deskewed());
  settings.scans.deskewed = Deskewed::kNo;
  EXPECT_FALSE(deskewed());
  settings.scans.deskewed = Deskewed::kGuess;
  folder.write("times.txt", "0.pcd 100.0 100.1\n");
  EXPECT_FALSE(deskewed());
}

TEST(ImportClouds, StockClassesHoldTheSamePoints) {
  const test::TempDir folder;
  folder.write("scans/0.pcd", asciiPcd("t", "U", {"1 2 3 0", "4 5 6 90000000"}));
  folder.write("scans/1.pcd", asciiPcd("", "", {"1 2 3"}));
  folder.write("times.txt", "0.pcd 100.0\n1.pcd 100.1");
  auto settings = cloudSettings(folder);
  settings.scans.stock = true;
  importClouds(settings, [](double) {});
  const RecordingInfo info = readRecordingInfo(settings.output.file);
  ASSERT_EQ(info.sensors.size(), 2U);
  EXPECT_EQ(info.sensors[0].class_name, "CObservationPointCloud");
  EXPECT_EQ(info.sensors[0].points, (std::vector<std::uint64_t>{1}));
  EXPECT_EQ(info.sensors[1].class_name, "CObservationVelodyneScan");
  EXPECT_EQ(info.sensors[1].points, (std::vector<std::uint64_t>{2}));
  EXPECT_EQ(info.sensors[1].with_point_times, 1U);
}

TEST(ImportClouds, SaysWhatIsWrong) {
  const test::TempDir folder;
  const auto settings = cloudSettings(folder);
  EXPECT_THROW(importClouds(settings, [](double) {}), IoError);  // no folder
  folder.write("scans/0.pcd", "broken");
  EXPECT_THROW(importClouds(settings, [](double) {}), IoError);  // no times
  for (const char* times : {"", "0.pcd\n", "0.pcd abc\n", "0.pcd 1 0.5\n", "0.pcd 1 2 3\n",
                            "missing.pcd 1\n", "0.pcd 1\n"}) {
    folder.write("times.txt", times);
    auto again = settings;
    again.output.overwrite = true;
    EXPECT_THROW(importClouds(again, [](double) {}), IoError) << times;
  }
  for (const char* csv :
       {"", "t_s,ax_mps2\n1,2\n", "t_s,ax_mps2,ay_mps2,az_mps2,wx_radps,wy_radps,wz_radps\n",
        "t_s,ax_mps2,ay_mps2,az_mps2,wx_radps,wy_radps,wz_radps\n1,2,3,4,5,6\n",
        "t_s,ax_mps2,ay_mps2,az_mps2,wx_radps,wy_radps,wz_radps\n1,2,3,x,5,6,7\n"}) {
    EXPECT_THROW(readImuCsv(folder.write("imu.csv", csv)), IoError) << csv;
  }
  for (const char* pose : {"", "1,2,3,4,5", "1,2,3,4,5,6,7", "1,2,3,4,5,x", "1,2,3,4,5,nan"}) {
    EXPECT_THROW(parsePose(pose, "--T-body-lidar"), UsageError) << pose;
  }
}

std::string kittiPoints(const std::vector<std::array<float, 4>>& points) {
  std::string bytes(points.size() * 16, '\0');
  std::memcpy(bytes.data(), points.data(), bytes.size());
  return bytes;
}

// A drive laid out as KITTI publishes it; the car drives east, 1 m a frame, at 49 degrees north.
void writeDrive(const test::TempDir& folder) {
  const std::string drive = "2011_09_26/2011_09_26_drive_0001_sync/";
  folder.write("2011_09_26/calib_imu_to_velo.txt",
               "calib_time: 25-May-2012 16:47:16\nR: 1 0 0 0 1 0 0 0 1\nT: -0.8 0.3 -0.7\n");
  std::string forward, start, end, oxts;
  for (int i = 0; i < 3; ++i) {
    const std::string number = "000000000" + std::to_string(i);
    const std::string second = std::to_string(25 + i);
    start += "2011-09-26 13:02:" + second + ".900000000\n";
    forward += "2011-09-26 13:02:" + second + ".950000000\n";
    end += "2011-09-26 13:02:" + std::to_string(26 + i) + ".000000001\n";
    oxts += "2011-09-26 13:02:" + second + ".964389445\n";
    folder.write(drive + "velodyne_points/data/" + number + ".bin",
                 kittiPoints({{-5, 1e-4F, 0, 0.5F}, {0, 5, 0, 1}, {5, 0, 0, 0}, {0, -5, 0, 0}}));
    const double lon_deg =
        8 + i / (6378137 * std::cos(49 * std::numbers::pi / 180)) * 180 / std::numbers::pi;
    char packet[400];
    std::snprintf(packet, sizeof(packet),
                  "49 %.12f 112 0 0 0 0 10 10 0 0 0.1 0.2 9.8 7 7 7 0.01 0.02 0.03 7 7 7 0.05 0.01 "
                  "4 6 4 4 0\n",
                  lon_deg);
    folder.write(drive + "oxts/data/" + number + ".txt", packet);
  }
  folder.write(drive + "velodyne_points/timestamps.txt", forward);
  folder.write(drive + "velodyne_points/timestamps_start.txt", start);
  folder.write(drive + "velodyne_points/timestamps_end.txt", end);
  folder.write(drive + "oxts/timestamps.txt", oxts);
}

TEST(ImportKitti, ReadsADriveAsPublished) {
  const test::TempDir folder;
  writeDrive(folder);
  ImportKittiSettings settings;
  settings.drive = folder / "2011_09_26" / "2011_09_26_drive_0001_sync";
  settings.output.file = folder / "log.rawlog";
  settings.output.overwrite = true;
  for (const bool azimuth : {false, true}) {
    settings.scans.azimuth_times = azimuth;
    const ImportSummary summary = importKitti(settings, [](double) {});
    EXPECT_TRUE(summary.complete());
    const auto all = readAll(settings.output.file);
    ASSERT_EQ(all.size(), 9U);
    const auto scan = std::dynamic_pointer_cast<CObservationLidarScan>(all[0]);
    ASSERT_TRUE(scan);
    EXPECT_EQ(fromMrptTime(scan->timestamp), 1317042145'900000000);
    EXPECT_NEAR(scan->sensorPoseOnRobot.x(), 0.8, 1e-12);
    EXPECT_EQ(scan->intensity, (std::vector<std::uint16_t>{128, 255, 0, 0}));
    EXPECT_EQ(scan->duration_ns, 100'000'001U);
    EXPECT_FALSE(scan->deskewed);
    ASSERT_EQ(scan->dt_ns.size(), azimuth ? 4U : 0U);
    for (std::size_t i = 0; i < scan->dt_ns.size(); ++i) {  // back, left, forward, right
      EXPECT_NEAR(scan->dt_ns[i], 25e6 * static_cast<double>(i), 2e3);
    }
    const auto imu = std::dynamic_pointer_cast<mrpt::obs::CObservationIMU>(all[1]);
    ASSERT_TRUE(imu);
    EXPECT_EQ(imu->get(mrpt::obs::IMU_Z_ACC), 9.8);
    EXPECT_EQ(imu->get(mrpt::obs::IMU_WX), 0.01);
    const auto pose = std::dynamic_pointer_cast<mrpt::obs::CObservationRobotPose>(all[8]);
    ASSERT_TRUE(pose);
    EXPECT_NEAR(pose->pose.mean.x(), 2, 1e-5);
    EXPECT_NEAR(pose->pose.mean.y(), 0, 1e-5);
  }
  std::filesystem::remove(folder / "2011_09_26" / "calib_imu_to_velo.txt");
  EXPECT_THROW(importKitti(settings, [](double) {}), IoError);
}

TEST(Info, TellsGapsAndDamage) {
  const test::TempDir folder;
  RawlogWriter writer(folder / "a.rawlog");
  const double steps[] = {0, 0.1, 0.1, 0.1, 0.3, 0.1, -0.05, 0.15, 0.1};
  TimeNs t = kStart;
  for (const double step : steps) {
    CObservationLidarScan scan;
    scan.sensorLabel = "lidar";
    scan.timestamp = toMrptTime(t += nsFromSeconds(step));
    scan.x = scan.y = scan.z = {1, 2};
    writer.write(scan);
  }
  writer.close();
  const RecordingInfo info = readRecordingInfo(folder / "a.rawlog");
  ASSERT_EQ(info.sensors.size(), 1U);
  EXPECT_EQ(info.sensors[0].count, 9U);
  EXPECT_EQ(info.damage, "");
  const StampSteps found = stepsOf(info.sensors[0]);
  EXPECT_NEAR(found.period_s, 0.1, 1e-9);
  EXPECT_EQ(found.gaps, 1U);
  EXPECT_NEAR(found.largest_gap_s, 0.3, 1e-9);
  EXPECT_NEAR(found.largest_gap_at_s, 0.3, 1e-9);
  EXPECT_EQ(found.backwards, 1U);
  const std::string bytes = test::readFile(folder / "a.rawlog");
  const auto cut = folder.write("cut.rawlog", bytes.substr(0, bytes.size() - 7));
  const RecordingInfo damaged = readRecordingInfo(cut);
  EXPECT_EQ(damaged.sensors[0].count, 8U);
  EXPECT_NE(damaged.damage.find("object 9"), std::string::npos) << damaged.damage;
  EXPECT_THROW(readRecordingInfo(folder.write("text.rawlog", "hello")), IoError);
  EXPECT_THROW(readRecordingInfo(folder.write("empty.rawlog", "")), IoError);
}

}  // namespace
}  // namespace paloc

#include <gtest/gtest.h>
#include <mrpt/obs/CObservationRotatingScan.h>
#include <mrpt/obs/CObservationVelodyneScan.h>

#include <cmath>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <numbers>

#include "paloc/frontends/lidar_decoder.h"
#include "paloc/frontends/mrpt_time.h"
#include "paloc/frontends/rawlog_stream.h"

namespace paloc {
namespace {

using mrpt::obs::CObservationVelodyneScan;
using Packet = CObservationVelodyneScan::TVelodyneRawPacket;

constexpr TimeNs kStamp = 1'645'002'364'000'000'000;

// Writes the bytes of a data packet as the manual has them: little-endian, 12 blocks of flag
// 0xFFEE, azimuth, 32 returns of 3 bytes; then time of the hour, return mode, product.
class PacketBytes {
 public:
  void setAzimuth(int block, int hundredths) {
    put16(block * 100, 0xEEFF);
    put16(block * 100 + 2, hundredths);
  }
  void setReturn(int block, int index, int units, int intensity) {
    put16(block * 100 + 4 + index * 3, units);
    bytes_[block * 100 + 6 + index * 3] = static_cast<std::uint8_t>(intensity);
  }
  Packet packet(std::uint32_t microseconds, int mode, int product) {
    put16(1200, static_cast<int>(microseconds & 0xFFFF));
    put16(1202, static_cast<int>(microseconds >> 16));
    bytes_[1204] = static_cast<std::uint8_t>(mode);
    bytes_[1205] = static_cast<std::uint8_t>(product);
    Packet packet;
    static_assert(sizeof packet == 1206);
    std::memcpy(static_cast<void*>(&packet), bytes_, sizeof packet);
    return packet;
  }

 private:
  void put16(int at, int value) {
    bytes_[at] = static_cast<std::uint8_t>(value & 0xFF);
    bytes_[at + 1] = static_cast<std::uint8_t>(value >> 8);
  }
  std::uint8_t bytes_[1206] = {};
};

CObservationVelodyneScan scanOf(std::vector<Packet> packets) {
  CObservationVelodyneScan scan;
  scan.timestamp = toMrptTime(kStamp);
  scan.sensorLabel = "vlp";
  scan.scan_packets = std::move(packets);
  return scan;
}

LidarFrame decoded(const mrpt::obs::CObservation& scan) {
  std::string refusal;
  auto frame = decodeLidar(scan, {true, true}, refusal);
  if (!frame) {
    ADD_FAILURE() << refusal;
    return {};
  }
  return *frame;
}

// A VLP-16 at 10 Hz turns by 0.398 degrees in a block; here 0.40.
TEST(Vlp16Packets, OneReturnIsWhereAndWhenTheManualSays) {
  PacketBytes first, second;
  for (int b = 0; b < 12; ++b) {
    first.setAzimuth(b, (35'600 + b * 40) % 36'000);
    second.setAzimuth(b, (35'600 + (12 + b) * 40) % 36'000);
  }
  second.setReturn(3, 16 + 5, 2500, 77);  // second firing, laser 5, 5 m away
  // Between the packets the sensor's clock starts anew, at the full hour.
  const LidarFrame frame =
      decoded(scanOf({first.packet(3'599'999'500U, 0x37, 0x22), second.packet(827, 0x37, 0x22)}));
  ASSERT_EQ(frame.points_lidar.size(), 1U);
  EXPECT_EQ(frame.invalid_points, 2U * 384U - 1U);
  const TimeNs in_block = 55'296 + 5 * 2'304;
  EXPECT_EQ(frame.dt_ns[0], 1'327'000 + 3 * 110'592 + in_block);
  EXPECT_EQ(frame.ring[0], 5);
  EXPECT_EQ(frame.intensity[0], 77.0F);
  const double azimuth_deg = 356.0 + 15 * 0.40 + 0.40 * static_cast<double>(in_block) / 110'592;
  const double a = azimuth_deg * std::numbers::pi / 180;
  const double elevation =
      5 * std::numbers::pi / 180;  // the manual's table: laser 5 looks up 5 deg
  EXPECT_NEAR(frame.points_lidar[0].x, 5 * std::cos(elevation) * std::cos(a), 1e-5);
  EXPECT_NEAR(frame.points_lidar[0].y, -5 * std::cos(elevation) * std::sin(a), 1e-5);
  EXPECT_NEAR(frame.points_lidar[0].z, 5 * std::sin(elevation), 1e-5);
  EXPECT_EQ(frame.duration_ns, 1'327'000 + 12 * 110'592 - 55'296 + 15 * 2'304);
  EXPECT_NE(frame.time_policy.find("VLP-16"), std::string::npos);
}

TEST(Vlp16Packets, BothFiringsOfABlockCount) {
  PacketBytes bytes;
  for (int b = 0; b < 12; ++b) {
    bytes.setAzimuth(b, b * 40);
    for (int i = 0; i < 32; ++i) bytes.setReturn(b, i, 1000 + b, 1);
  }
  const LidarFrame frame = decoded(scanOf({bytes.packet(0, 0x37, 0x22)}));
  ASSERT_EQ(frame.points_lidar.size(), 384U);
  for (std::size_t i = 1; i < 384; ++i) EXPECT_GT(frame.dt_ns[i], frame.dt_ns[i - 1]);
  // The last block turns like the one before it.
  const Point3f& p = frame.points_lidar[11 * 32 + 16];
  EXPECT_NEAR(std::atan2(-p.y, p.x) * 180 / std::numbers::pi, 4.4 + 0.2, 1e-4);
}

TEST(Vlp16Packets, DualReturnsShareTimeAndAzimuthAndEqualOnesCountOnce) {
  PacketBytes bytes;
  for (int b = 0; b < 12; ++b) {
    bytes.setAzimuth(b, b / 2 * 40);
    bytes.setReturn(b, 0, b % 2 == 0 ? 1000 : 2000, 1);
    bytes.setReturn(b, 1, 1500, 1);
  }
  const LidarFrame frame = decoded(scanOf({bytes.packet(0, 0x39, 0x22)}));
  EXPECT_EQ(frame.points_lidar.size(), 6U * 3U);
  EXPECT_EQ(frame.dt_ns.back(), 5 * 110'592U);
  const Point3f &a = frame.points_lidar[0], &b = frame.points_lidar[2];
  EXPECT_NEAR(b.x, 2 * a.x, 1e-5);
  EXPECT_EQ(frame.dt_ns[0], frame.dt_ns[2]);
}

TEST(Vlp16Packets, AStandingClockIsCountedOut) {
  PacketBytes bytes;
  for (int b = 0; b < 12; ++b) bytes.setAzimuth(b, b * 40);
  bytes.setReturn(0, 0, 1000, 1);
  const Packet packet = bytes.packet(5, 0x37, 0x22);
  const LidarFrame frame = decoded(scanOf({packet, packet, packet}));
  EXPECT_EQ(frame.dt_ns, (std::vector<std::uint32_t>{0, 1'327'104, 2 * 1'327'104}));
  EXPECT_NE(frame.time_policy.find("counting"), std::string::npos);
}

TEST(Vlp16Packets, TheObservationsCalibrationHolds) {
  PacketBytes bytes;
  for (int b = 0; b < 12; ++b) bytes.setAzimuth(b, 0);
  bytes.setReturn(0, 2, 1000, 1);
  auto scan = scanOf({bytes.packet(0, 0x37, 0x22)});
  scan.calibration.laser_corrections.resize(16);
  auto& c = scan.calibration.laser_corrections[2];
  c.verticalCorrection = 30;
  c.azimuthCorrection = 90;
  c.distanceCorrection = 0.5;
  c.verticalOffsetCorrection = 0.01;
  const LidarFrame frame = decoded(scan);
  ASSERT_EQ(frame.points_lidar.size(), 1U);
  EXPECT_NEAR(frame.points_lidar[0].x, 0, 1e-6);
  EXPECT_NEAR(frame.points_lidar[0].y, -2.5 * std::cos(std::numbers::pi / 6), 1e-5);
  EXPECT_NEAR(frame.points_lidar[0].z, 2.5 * 0.5 + 0.01, 1e-5);
}

TEST(Hdl32Packets, FiringTimesAndRings) {
  PacketBytes bytes;
  for (int b = 0; b < 12; ++b) bytes.setAzimuth(b, b * 17);
  bytes.setReturn(2, 31, 500, 1);
  const LidarFrame frame = decoded(scanOf({bytes.packet(0, 0x37, 0x21)}));
  ASSERT_EQ(frame.points_lidar.size(), 1U);
  EXPECT_EQ(frame.dt_ns[0], 2 * 46'080U + 31 * 1'152U);
  EXPECT_EQ(frame.ring[0], 31);
  EXPECT_NEAR(frame.points_lidar[0].z, std::sin(10.67 * std::numbers::pi / 180), 1e-5);
}

TEST(VelodynePackets, OtherModelsAreRefused) {
  PacketBytes bytes;
  std::string refusal;
  EXPECT_FALSE(decodeLidar(scanOf({bytes.packet(0, 0x37, 0x28)}), {}, refusal));
  EXPECT_EQ(refusal, "its packets are of a model other than VLP-16 and HDL-32E");
}

mrpt::obs::CObservation::Ptr firstOf(const std::string& name) {
  const char* told = std::getenv("PALOC_MRPT_DATASETS");
  const auto file = std::filesystem::path(told ? told : "/usr/share/mrpt/datasets") / name;
  return std::filesystem::exists(file) ? RawlogStream(file).next() : nullptr;
}

TEST(VelodynePackets, RealScanHasAllItsReturns) {
  const auto observation = firstOf("test_velodyne_VLP16.rawlog");
  if (!observation) GTEST_SKIP() << "package mrpt-common is not installed";
  const LidarFrame frame = decoded(*observation);
  EXPECT_EQ(frame.points_lidar.size(), 22'591U);  // MRPT's own decoder: 11,305
  EXPECT_EQ(frame.points_lidar.size() + frame.invalid_points, 75U * 384U);
  EXPECT_NEAR(static_cast<double>(frame.duration_ns) * 1e-6, 100, 2);
}

TEST(RotatingScan, RealImageHasTheAnglesOfItsModel) {
  const auto observation = firstOf("rot_scan_velodyne.rawlog");
  if (!observation) GTEST_SKIP() << "package mrpt-common is not installed";
  const LidarFrame frame = decoded(*observation);
  EXPECT_GT(frame.points_lidar.size(), 5'000U);
  for (std::size_t i = 0; i < frame.points_lidar.size(); ++i) {
    const Point3f& p = frame.points_lidar[i];
    const double elevation = std::atan2(p.z, std::hypot(p.x, p.y)) * 180 / std::numbers::pi;
    ASSERT_NEAR(std::abs(std::remainder(elevation - 15, 2)), 0, 1e-3);
  }
}

}  // namespace
}  // namespace paloc

#include "paloc/tools/ros_cloud.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

#include "paloc/tools/static_transforms.h"
#include "ros_bytes.h"

namespace paloc {
namespace {

using Bytes = std::vector<std::uint8_t>;

struct Layout {
  const char* sensor;
  std::uint8_t xyz_type;
  const char* time;
  std::uint8_t time_type;
  const char* intensity;
  std::uint8_t intensity_type;
  const char* ring;
  std::uint8_t ring_type;
};

void store(Bytes& data, std::size_t at, std::uint8_t type, double value) {
  const auto as = [&](auto typed) { std::memcpy(data.data() + at, &typed, sizeof(typed)); };
  if (type == 2) as(static_cast<std::uint8_t>(value));
  if (type == 4) as(static_cast<std::uint16_t>(value));
  if (type == 6) as(static_cast<std::uint32_t>(value));
  if (type == 7) as(static_cast<float>(value));
  if (type == 8) as(value);
}

// Two rows of two points, rows padded: (1 2 3), not finite, (0 0 0), (4 5 6).
Bytes message(const Layout& layout, const std::vector<double>& times, bool big_endian = false,
              std::size_t missing = 0) {
  constexpr std::uint32_t kStep = 64, kRow = 2 * kStep + 8;
  test::RosBuilder b;
  b.header(1700000000, 123456789, "/os_lidar").put(std::uint32_t{2}).put(std::uint32_t{2});
  b.put(std::uint32_t{6});
  b.field(layout.ring, 1, layout.ring_type).field(layout.time, 8, layout.time_type);
  b.field("z", 16, layout.xyz_type).field("y", 24, layout.xyz_type);
  b.field("x", 32, layout.xyz_type).field(layout.intensity, 40, layout.intensity_type);
  b.put(static_cast<std::uint8_t>(big_endian)).put(kStep).put(kRow);
  Bytes data(2 * kRow - missing);
  const double xyz[4][3] = {{1, 2, 3}, {NAN, 0, 0}, {0, 0, 0}, {4, 5, 6}};
  for (std::size_t i = 0; i < 4 && missing == 0; ++i) {
    const std::size_t at = (i / 2) * kRow + (i % 2) * kStep;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      store(data, at + 32 - 8 * axis, layout.xyz_type, xyz[i][axis]);
    }
    store(data, at + 8, layout.time_type, times[i]);
    store(data, at + 40, layout.intensity_type, static_cast<double>(10 + i));
    store(data, at + 1, layout.ring_type, static_cast<double>(20 + i));
  }
  b.put(static_cast<std::uint32_t>(data.size()));
  for (const std::uint8_t byte : data) b.put(byte);
  return b.put(std::uint8_t{0}).bytes();
}

constexpr Layout kOuster{"Ouster", 7, "t", 6, "intensity", 7, "ring", 4};

TEST(RosCloud, IsReadInEveryLayout) {
  const Layout layouts[] = {kOuster,
                            {"Ouster, early", 7, "t", 6, "intensity", 7, "ring", 2},
                            {"Velodyne", 7, "time", 7, "intensity", 7, "ring", 4},
                            {"Hesai", 7, "timestamp", 8, "intensity", 7, "ring", 4},
                            {"RoboSense", 8, "timestamp", 8, "intensity", 2, "ring", 4},
                            {"Livox", 7, "offset_time", 6, "reflectivity", 2, "line", 2}};
  for (const Layout& layout : layouts) {
    std::string refusal;
    const Bytes bytes = message(layout, {0.5, 1, 2, 90000000});
    const auto read = readPointCloud2(bytes, "", refusal);
    ASSERT_TRUE(read) << layout.sensor << ": " << refusal;
    EXPECT_EQ(read->stamp_ns, 1700000000'123456789);
    EXPECT_EQ(read->frame, "os_lidar");
    const PointCloud& cloud = read->cloud;
    ASSERT_EQ(cloud.size(), 2U) << layout.sensor;
    EXPECT_EQ(cloud.points[0].x, 1.F);
    EXPECT_EQ(cloud.points[1].z, 6.F);
    EXPECT_EQ(cloud.nonfinite_dropped, 1U);
    EXPECT_EQ(read->zero_dropped, 1U);
    EXPECT_EQ(cloud.intensity, (std::vector<float>{10, 13}));
    EXPECT_EQ(cloud.ring, (std::vector<std::uint16_t>{20, 23}));
    EXPECT_EQ(cloud.time_field, layout.time);
    EXPECT_EQ(cloud.time_is_integer, layout.time_type == 6);
    EXPECT_EQ(cloud.time, (std::vector<double>{layout.time_type == 6 ? 0 : 0.5, 90000000}));
  }
}

TEST(RosCloud, FieldOfTimesCanBeNamed) {
  const Layout odd{"odd", 7, "when", 8, "intensity", 7, "ring", 4};
  std::string refusal;
  const Bytes bytes = message(odd, {1, 2, 3, 4});
  EXPECT_TRUE(readPointCloud2(bytes, "", refusal)->cloud.time.empty());
  EXPECT_EQ(readPointCloud2(bytes, "when", refusal)->cloud.time, (std::vector<double>{1, 4}));
}

TEST(RosCloud, WhatIsWrongIsRefusedAndNothingReadBeyondTheMessage) {
  std::string refusal;
  EXPECT_FALSE(readPointCloud2(message(kOuster, {0, 0, 0, 0}, true), "", refusal));
  EXPECT_NE(refusal.find("big endian"), std::string::npos);
  EXPECT_FALSE(readPointCloud2(message(kOuster, {0, 0, 0, 0}, false, 9), "", refusal));
  EXPECT_NE(refusal.find("less data"), std::string::npos);
  const Layout integers{"integers", 4, "t", 6, "intensity", 7, "ring", 4};
  EXPECT_FALSE(readPointCloud2(message(integers, {0, 0, 0, 0}), "", refusal));
  const Bytes whole = message(kOuster, {0, 0, 0, 0});
  for (std::size_t size = 0; size < whole.size(); ++size) {
    EXPECT_FALSE(readPointCloud2(Bytes(whole.begin(), whole.begin() + static_cast<long>(size)), "",
                                 refusal));
  }
}

Bytes livox(std::uint64_t timebase_ns, std::uint32_t claimed) {
  test::RosBuilder b;
  b.header(1700000000, 123456700, "livox").put(timebase_ns).put(std::uint32_t{2});
  b.put(std::uint32_t{0}).put(claimed);
  for (std::uint32_t i = 0; i < 2; ++i) {
    b.put(i * 1000000).put(1.F).put(2.F).put(3.F);
    b.put(std::uint8_t{50}).put(std::uint8_t{0}).put(std::uint8_t{3});
  }
  return b.bytes();
}

TEST(LivoxCustom, CountsFromItsTimebase) {
  std::string refusal;
  const auto read = readLivoxCustom(livox(1700000000'123456789, 2), refusal);
  ASSERT_TRUE(read) << refusal;
  EXPECT_EQ(read->stamp_ns, 1700000000'123456789);  // the header lost the last digits
  EXPECT_FALSE(read->timebase_differs);
  EXPECT_EQ(read->cloud.time, (std::vector<double>{0, 1000000}));
  EXPECT_EQ(read->cloud.intensity, (std::vector<float>{50, 50}));
  EXPECT_EQ(read->cloud.ring, (std::vector<std::uint16_t>{3, 3}));
  const auto other_clock = readLivoxCustom(livox(5, 2), refusal);
  EXPECT_TRUE(other_clock->timebase_differs);
  EXPECT_EQ(other_clock->stamp_ns, 1700000000'123456700);
}

TEST(LivoxCustom, IsRefusedWhereItDoesNotHoldWhatItSays) {
  std::string refusal;
  for (const std::uint32_t claimed : {0U, 1U, 3U, 0xffffffffU}) {
    EXPECT_FALSE(readLivoxCustom(livox(5, claimed), refusal)) << claimed;
  }
  const Bytes whole = livox(5, 2);
  for (std::size_t size = 0; size < whole.size(); ++size) {
    EXPECT_FALSE(
        readLivoxCustom(Bytes(whole.begin(), whole.begin() + static_cast<long>(size)), refusal));
  }
}

TEST(StaticTransforms, AreFollowedBothWays) {
  Pose lidar, imu;
  lidar.position = Vec3(0, 0, 1);
  imu.rotation = so3::exp(Vec3(0, 0, 1.5707963267948966));
  StaticTransforms transforms;
  transforms.add({"base", "lidar", lidar});
  transforms.add({"base", "imu", imu});
  const auto T_imu_lidar = transforms.find("imu", "lidar");
  ASSERT_TRUE(T_imu_lidar);
  EXPECT_NEAR(((*T_imu_lidar) * Vec3(1, 0, 0) - Vec3(0, -1, 1)).norm(), 0, 1e-12);
  EXPECT_FALSE(transforms.find("imu", "camera"));
  EXPECT_TRUE(transforms.find("same", "same"));
}

}  // namespace
}  // namespace paloc

#include <gtest/gtest.h>

#include <array>
#include <limits>

#include "cloud_files.h"

namespace paloc {
namespace {

using test::expectRefused;
using test::pointOf;
using test::put;
using test::putAt;

constexpr std::array<std::uint16_t, 11> kRecordBytes{20, 28, 26, 34, 57, 63, 30, 36, 38, 59, 67};

// A LAS file of points at UTM coordinates: (i, 2 i, 3 i) mm from the offset.
std::string las(int minor, int format, int points, std::uint16_t extra_bytes = 0) {
  const std::size_t header = minor == 4 ? 375 : minor == 3 ? 235 : 227;
  std::string bytes = "LASF" + std::string(header - 4, '\0');
  putAt<std::uint8_t>(bytes, 24, 1);
  putAt(bytes, 25, static_cast<std::uint8_t>(minor));
  putAt(bytes, 94, static_cast<std::uint16_t>(header));
  putAt(bytes, 96, static_cast<std::uint32_t>(header + 10));
  putAt(bytes, 104, static_cast<std::uint8_t>(format));
  const auto record =
      static_cast<std::uint16_t>(kRecordBytes[static_cast<std::size_t>(format)] + extra_bytes);
  putAt(bytes, 105, record);
  if (minor == 4 && format >= 6) {
    putAt(bytes, 247, static_cast<std::uint64_t>(points));
  } else {
    putAt(bytes, 107, static_cast<std::uint32_t>(points));
  }
  for (const std::size_t axis : {0U, 1U, 2U}) putAt(bytes, 131 + 8 * axis, 0.001);
  putAt(bytes, 155, 512'345.5);
  putAt(bytes, 163, 5'403'210.25);
  putAt(bytes, 171, 250.125);
  bytes += std::string(10, '\0');  // a gap before the points
  const bool time = format == 1 || (format >= 3 && format <= 5) || format >= 6;
  for (int i = 0; i < points; ++i) {
    std::string point;
    put(point, std::int32_t{i});
    put(point, std::int32_t{2 * i});
    put(point, std::int32_t{3 * i});
    put(point, static_cast<std::uint16_t>(i % 60'000));
    point.resize(record, '\x55');
    if (time) putAt(point, format >= 6 ? 22 : 20, 1e5 + 0.25 * i);
    bytes += point;
  }
  return bytes;
}

void expectPoints(const PointCloud& cloud, int points) {
  ASSERT_EQ(cloud.size(), static_cast<std::size_t>(points));
  EXPECT_EQ(cloud.points_read, cloud.size());
  for (int i = 0; i < points; i += 7) {
    const auto k = static_cast<std::size_t>(i);
    const Vec3 expected(512'345.5 + 0.001 * i, 5'403'210.25 + 0.002 * i, 250.125 + 0.003 * i);
    ASSERT_LT((pointOf(cloud, k) - expected).norm(), 1e-4) << i;
    ASSERT_EQ(cloud.intensity[k], static_cast<float>(i));
  }
}

TEST(Las, ReadsAllVersionsAndPointFormats) {
  const test::TempDir folder;
  for (int format = 0; format <= 10; ++format) {
    for (const int minor : {2, 3, 4}) {
      if ((format > 3 && minor == 2) || (format > 5 && minor == 3)) continue;
      const auto extra = static_cast<std::uint16_t>(format);  // bytes that the format does not know
      const PointCloud cloud = loadCloud(folder.write("a.las", las(minor, format, 5000, extra)));
      expectPoints(cloud, 5000);
      EXPECT_EQ(cloud.format,
                "LAS 1." + std::to_string(minor) + ", point format " + std::to_string(format));
      ASSERT_EQ(cloud.time.size(), format == 0 || format == 2 ? 0U : 5000U);
      if (!cloud.time.empty()) {
        EXPECT_EQ(cloud.time[8], 1e5 + 2);
      }
    }
  }
}

TEST(Las, WhatFollowsThePointsIsNoPoint) {
  const test::TempDir folder;
  std::string bytes = las(4, 6, 100);
  putAt(bytes, 235, static_cast<std::uint64_t>(bytes.size()));  // an extended record
  putAt(bytes, 243, std::uint32_t{1});
  expectPoints(loadCloud(folder.write("a.las", bytes + std::string(500, 'x'))), 100);
}

TEST(Las, RefusesWhatIsBroken) {
  const test::TempDir folder;
  const auto with = [](auto change) {
    std::string bytes = las(2, 1, 100);
    change(bytes);
    return bytes;
  };
  const auto refused = [&](const char* expected, auto change) {
    expectRefused(folder, "a.las", with(change), expected);
  };
  refused("its scale of y is 0", [](auto& b) { putAt(b, 139, 0.0); });
  refused("its scale of x is nan",
          [](auto& b) { putAt(b, 131, std::numeric_limits<double>::quiet_NaN()); });
  refused("its scale of z is -1", [](auto& b) { putAt(b, 147, -1.0); });
  refused("its offset of z is inf",
          [](auto& b) { putAt(b, 171, std::numeric_limits<double>::infinity()); });
  refused("records of 27 bytes are too short for point format 1 (28)",
          [](auto& b) { putAt(b, 105, std::uint16_t{27}); });
  refused("promises 101 points, but the file has room for 100",
          [](auto& b) { putAt(b, 107, std::uint32_t{101}); });
  refused("promises 99 points, but the file holds 100",
          [](auto& b) { putAt(b, 107, std::uint32_t{99}); });
  refused("promises 4294967295 points", [](auto& b) { putAt(b, 107, ~std::uint32_t{0}); });
  refused("has room for 99", [](auto& b) { b.pop_back(); });
  refused("ends within its LAS header", [](auto& b) { b.resize(200); });
  refused("no points", [](auto& b) { putAt(b, 107, std::uint32_t{0}); });
  refused("is compressed (LAZ)", [](auto& b) { b[104] = static_cast<char>(0x81); });
  refused("point format 11 is not known", [](auto& b) { b[104] = 11; });
  refused("is LAS 1.5", [](auto& b) { b[25] = 5; });
  refused("too short for version 1.4 (375)", [](auto& b) { b[25] = 4; });
  refused("begin at byte 100", [](auto& b) { putAt(b, 96, std::uint32_t{100}); });
  refused("begin at byte 4294967295", [](auto& b) { putAt(b, 96, ~std::uint32_t{0}); });
  expectRefused(folder, "b.las", "hello", "does not begin with 'LASF'");
}

}  // namespace
}  // namespace paloc

#include "paloc/map/cloud_io.h"

#include <gtest/gtest.h>

#include <cstring>
#include <random>

#include "cloud_files.h"

namespace paloc {
namespace {

using test::expectRefused;
using test::put;
using test::refusal;

std::string plyHeader(const std::string& format, int count, const std::string& properties) {
  return "ply\nformat " + format + " 1.0\ncomment made for a test\nelement vertex " +
         std::to_string(count) + "\n" + properties;
}

const std::string kXyz = "property float x\nproperty float y\nproperty float z\n";

TEST(Ply, ReadsAscii) {
  const test::TempDir folder;
  const auto file = folder.write(
      "a.ply", plyHeader("ascii", 3, kXyz + "property uchar ring\nproperty double time\n") +
                   "element face 1\nproperty list uchar int vertex_indices\nend_header\n"
                   "1 2.5 -3e-1 7 0.25\n\t nan 0 0 8 0.5 \r\n4 5 +6 9 1e9\n3 0 1 2\n");
  const PointCloud cloud = loadCloud(file);
  ASSERT_EQ(cloud.size(), 2U);
  EXPECT_EQ(cloud.nonfinite_dropped, 1U);
  EXPECT_FLOAT_EQ(cloud.points[0].y, 2.5F);
  EXPECT_FLOAT_EQ(cloud.points[0].z, -0.3F);
  EXPECT_FLOAT_EQ(cloud.points[1].z, 6);
  EXPECT_EQ(cloud.ring, (std::vector<std::uint16_t>{7, 9}));
  EXPECT_EQ(cloud.time, (std::vector<double>{0.25, 1e9}));
  EXPECT_EQ(cloud.time_field, "time");
  EXPECT_FALSE(cloud.time_is_integer);
  EXPECT_TRUE(cloud.intensity.empty());
}

TEST(Ply, ReadsBinaryOfEitherOrderWithAnyTypes) {
  const test::TempDir folder;
  for (const bool big : {false, true}) {
    std::string bytes =
        "ply\r\nformat " + std::string(big ? "binary_big_endian" : "binary_little_endian") +
        " 1.0\r\nelement camera 2\r\nproperty short id\r\nproperty list uchar float matrix\r\n"
        "element vertex 2\r\nproperty uchar red\r\nproperty double x\r\nproperty float y\r\n"
        "property int z\r\nproperty ushort scalar_Intensity\r\nproperty short ring\r\n"
        "property uint t\r\nproperty char c\r\nelement face 1\r\n"
        "property list uchar int vertex_indices\r\nend_header\r\n";
    for (const int items : {0, 3}) {
      put<std::int16_t>(bytes, 1, big);
      put<std::uint8_t>(bytes, static_cast<std::uint8_t>(items), big);
      for (int i = 0; i < items; ++i) put<float>(bytes, 1.0F, big);
    }
    for (const int i : {0, 1}) {
      put<std::uint8_t>(bytes, 255, big);
      put<double>(bytes, 0.125 + i, big);
      put<float>(bytes, -2.5F, big);
      put<std::int32_t>(bytes, -3 - i, big);
      put<std::uint16_t>(bytes, 60000, big);
      put<std::int16_t>(bytes, 127, big);
      put<std::uint32_t>(bytes, 4'000'000'000U, big);
      put<std::int8_t>(bytes, -1, big);
    }
    bytes += std::string("\1\0\0\0\0", 5);
    const PointCloud cloud = loadCloud(folder.write("b.ply", bytes));
    ASSERT_EQ(cloud.size(), 2U);
    EXPECT_EQ(cloud.points[1].x, 1.125F);
    EXPECT_EQ(cloud.points[1].y, -2.5F);
    EXPECT_EQ(cloud.points[1].z, -4.0F);
    EXPECT_EQ(cloud.intensity[1], 60000.0F);
    EXPECT_EQ(cloud.ring[0], 127);
    EXPECT_EQ(cloud.time[0], 4e9);
    EXPECT_TRUE(cloud.time_is_integer);
  }
}

TEST(Ply, WhatIsSavedComesBack) {
  const test::TempDir folder;
  std::mt19937_64 rng(1);
  std::uniform_real_distribution<float> uniform(-50, 50);
  PointCloud cloud;
  for (int i = 0; i < 70'000; ++i) {
    cloud.points.push_back({uniform(rng), uniform(rng), uniform(rng)});
    cloud.intensity.push_back(uniform(rng));
  }
  savePly(folder / "a.ply", cloud, "first line\nsecond line");
  const PointCloud back = loadCloud(folder / "a.ply");
  ASSERT_EQ(back.size(), cloud.size());
  EXPECT_TRUE(back.origin.isZero(0));
  EXPECT_EQ(std::memcmp(back.points.data(), cloud.points.data(), 12 * cloud.size()), 0);
  EXPECT_EQ(back.intensity, cloud.intensity);

  cloud.origin = Vec3(500'123.25, 5'400'321.5, 100);  // UTM
  savePly(folder / "far.ply", cloud);
  const PointCloud far = loadCloud(folder / "far.ply");
  ASSERT_EQ(far.size(), cloud.size());
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const auto& [x, y, z] = far.points[i];
    const auto& [cx, cy, cz] = cloud.points[i];
    ASSERT_LT((far.origin + Vec3(x, y, z) - cloud.origin - Vec3(cx, cy, cz)).norm(), 2e-5);
  }
}

TEST(Ply, RefusesWhatIsBroken) {
  const test::TempDir folder;
  const std::string end = "end_header\n";
  const std::string le = "binary_little_endian";
  const std::string point(12, '\0');
  const auto ply = [&](int count, const std::string& data) {
    return plyHeader(le, count, kXyz) + end + data;
  };
  expectRefused(folder, "a.ply", ply(3, point + point), "promises 3");
  expectRefused(folder, "b.ply", ply(1'000'000'000, point), "has room for 1");
  expectRefused(folder, "c.ply", ply(1, point + point), "the file holds 2");
  expectRefused(folder, "d.ply", ply(0, ""), "no points");
  expectRefused(folder, "e.ply", "ply\n", "end_header");
  expectRefused(folder, "f.ply", "plx\n", "does not begin with 'ply'");
  expectRefused(folder, "g.ply", "", "is empty");
  expectRefused(folder, "h.ply", plyHeader("binary_middle_endian", 1, kXyz) + end, "not known");
  expectRefused(folder, "i.ply", plyHeader(le, 1, "property float x\n") + end + "0000", "'y'");
  expectRefused(folder, "j.ply", plyHeader(le, 1, "property foo x\n") + end, "line 5: type 'foo'");
  expectRefused(folder, "k.ply", "ply\nelement vertex -5\n" + kXyz + end, "line 2");
  expectRefused(folder, "l.ply", "ply\nelement vertex 99999999999999999999\n" + end, "line 2");
  expectRefused(folder, "m.ply", plyHeader(le, 1, "property list uchar float x\n") + end, "list");
  expectRefused(folder, "n.ply", "ply\ncomment " + std::string(3'000'000, 'x'), "line 2 is longer");
  std::string endless = "ply\nformat ascii 1.0\n";
  for (int i = 0; i < 100'000; ++i) endless += "comment of " + std::string(40, 'x') + "\n";
  expectRefused(folder, "endless.ply", endless, "no 'end_header'");
  expectRefused(folder, "o.ply", "ply\nformat ascii 1.0\n" + end, "no element 'vertex'");
  const std::string ascii = plyHeader("ascii", 2, kXyz) + end;
  expectRefused(folder, "p.ply", ascii + "1 2 3\n", "promises 2 points");
  expectRefused(folder, "q.ply", ascii + "1 2 3\n4 5\n6 7 8", "line 10: has fewer than 3");
  expectRefused(folder, "r.ply", ascii + "1 2 3\n4 5 6 7\n", "line 10: has more than 3");
  expectRefused(folder, "s.ply", ascii + "1 2 3\n4 abc 6\n",
                "line 10: 'abc' is not a number (field 'y')");
  expectRefused(folder, "t.ply", ascii + "1 2 3\n4 5 6\n7 8 9\n", "more lines follow");
  expectRefused(folder, "u.ply", plyHeader("ascii", 1, kXyz) + end + "nan 1 2\n", "none of its 1");
  expectRefused(folder, "v.foo", "hello", "no point cloud");
  EXPECT_NE(refusal(folder / "missing.ply").find("No such file"), std::string::npos);
  EXPECT_NE(refusal(folder.path()).find("is a folder, not a point cloud"), std::string::npos);
}

TEST(Ply, SurvivesTruncationAndDamage) {
  const test::TempDir folder;
  std::string whole = plyHeader("binary_little_endian", 20, kXyz + "property list uchar int i\n");
  whole.replace(whole.find("property list"), 0, "element face 2\n");
  whole += "end_header\n";
  for (int i = 0; i < 60; ++i) put<float>(whole, 0.5F);
  const std::size_t points_end = whole.size();
  whole += std::string("\1\0\0\0\0\1\0\0\0\0", 10);
  for (std::size_t length = 0; length < points_end; ++length) {
    EXPECT_FALSE(refusal(folder.write("t.ply", whole.substr(0, length))).empty()) << length;
  }
  std::mt19937_64 rng(2);
  for (int run = 0; run < 200; ++run) {
    std::string damaged = whole;
    for (int i = 0; i < 3; ++i) damaged[rng() % 200] = static_cast<char>(rng());
    refusal(folder.write("d.ply", damaged));  // reads or refuses, never crashes
  }
}

std::string pcdHeader(const std::string& fields, const std::string& sizes, const std::string& types,
                      const std::string& counts, int points, const std::string& data) {
  const std::string n = std::to_string(points);
  return "# .PCD v0.7 - Point Cloud Data file format\nVERSION 0.7\nFIELDS " + fields + "\nSIZE " +
         sizes + "\nTYPE " + types + "\nCOUNT " + counts + "\nWIDTH " + n +
         "\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS " + n + "\nDATA " + data + "\n";
}

TEST(Pcd, ReadsAscii) {
  const test::TempDir folder;
  const auto file = folder.write(
      "a.pcd", pcdHeader("x y z hist t", "4 4 4 4 8", "F F F F U", "1 1 1 3 1", 2, "ascii") +
                   "1 2 3 0 0 0 1645002364537699938\n-1 -2 nan 0 0 0 5\n\n");
  const PointCloud cloud = loadCloud(file);
  ASSERT_EQ(cloud.size(), 1U);
  EXPECT_EQ(cloud.nonfinite_dropped, 1U);
  EXPECT_EQ(cloud.points[0].z, 3);
  EXPECT_NEAR(cloud.time[0], 1645002364537699938e0, 256);
  EXPECT_TRUE(cloud.time_is_integer);
}

// Points with padding, a field of several values and mixed types; as records, or field by field.
std::string pcdData(int points, bool by_field) {
  std::string columns[6];
  std::string records;
  for (int i = 0; i < points; ++i) {
    std::string values[6];
    put<float>(values[0], static_cast<float>(i));
    put<double>(values[1], 0.5 * i);
    put<float>(values[2], 7.0F);
    values[3] = std::string(5, '\7');
    put<std::uint16_t>(values[4], static_cast<std::uint16_t>(i % 128));
    put<double>(values[5], 0.1 * i);
    for (int f = 0; f < 6; ++f) {
      columns[f] += values[f];
      records += values[f];
    }
  }
  std::string all;
  for (const auto& column : columns) all += column;
  return by_field ? all : records;
}

void expectPcdData(const PointCloud& cloud, int points) {
  ASSERT_EQ(cloud.size(), static_cast<std::size_t>(points));
  for (int i = 0; i < points; ++i) {
    const auto k = static_cast<std::size_t>(i);
    ASSERT_EQ(cloud.origin.x() + static_cast<double>(cloud.points[k].x), i);
    ASSERT_EQ(cloud.origin.y() + static_cast<double>(cloud.points[k].y), 0.5 * i);
    ASSERT_EQ(cloud.points[k].z, 7.0F);
    ASSERT_EQ(cloud.ring[k], i % 128);
    ASSERT_EQ(cloud.time[k], 0.1 * i);
  }
  EXPECT_EQ(cloud.time_field, "timestamp");
}

std::string pcdFile(int points, const std::string& data) {
  return pcdHeader("x y z _ ring timestamp", "4 8 4 1 2 8", "F F F U U F", "1 1 1 5 1 1", points,
                   data);
}

TEST(Pcd, ReadsBinary) {
  const test::TempDir folder;
  const std::string bytes = pcdFile(1000, "binary") + pcdData(1000, false);
  expectPcdData(loadCloud(folder.write("a.pcd", bytes)), 1000);
  expectRefused(folder, "short.pcd", bytes.substr(0, bytes.size() - 1), "room for 999");
  expectRefused(folder, "long.pcd", bytes + std::string(31, '\0'), "the file holds 1001");
}

// A plain LZF packer: the longest earlier match within reach, or literals. Slow and enough here.
std::string packLzf(const std::string& in) {
  std::string out, literals;
  const auto flush = [&] {
    for (std::size_t i = 0; i < literals.size(); i += 32) {
      const std::string run = literals.substr(i, 32);
      out += static_cast<char>(run.size() - 1);
      out += run;
    }
    literals.clear();
  };
  for (std::size_t at = 0; at < in.size();) {
    std::size_t best = 0, best_distance = 0;
    for (std::size_t distance = 1; distance <= std::min<std::size_t>(at, 64); ++distance) {
      std::size_t length = 0;
      while (length < 264 && at + length < in.size() &&
             in[at + length] == in[at + length - distance]) {
        ++length;
      }
      if (length > best) best = length, best_distance = distance;
    }
    if (best < 3) {
      literals += in[at++];
      continue;
    }
    flush();
    const std::size_t code = best - 2, offset = best_distance - 1;
    if (code < 7) {
      out += static_cast<char>((code << 5) | (offset >> 8));
    } else {
      out += static_cast<char>((7U << 5) | (offset >> 8));
      out += static_cast<char>(code - 7);
    }
    out += static_cast<char>(offset & 255);
    at += best;
  }
  flush();
  return out;
}

TEST(Pcd, ReadsBinaryCompressed) {
  const test::TempDir folder;
  const std::string data = pcdData(5000, true);
  const std::string packed = packLzf(data);
  ASSERT_LT(packed.size(), data.size());
  std::string bytes = pcdFile(5000, "binary_compressed");
  put(bytes, static_cast<std::uint32_t>(packed.size()));
  put(bytes, static_cast<std::uint32_t>(data.size()));
  const std::size_t header = bytes.size();
  bytes += packed;
  expectPcdData(loadCloud(folder.write("a.pcd", bytes)), 5000);

  expectRefused(folder, "short.pcd", bytes.substr(0, bytes.size() - 1), "is truncated");
  std::string lying = bytes;
  lying.replace(lying.find("POINTS 5000"), 11, "POINTS 5001");
  lying.replace(lying.find("WIDTH 5000"), 10, "WIDTH 5001");
  expectRefused(folder, "lying.pcd", lying, "do not fit its compressed data");
  std::mt19937_64 rng(3);
  for (int run = 0; run < 300; ++run) {
    std::string damaged = bytes;
    damaged[header + rng() % packed.size()] = static_cast<char>(rng());
    refusal(folder.write("d.pcd", damaged));
  }
}

TEST(Pcd, RefusesWhatIsBroken) {
  const test::TempDir folder;
  const auto pcd = [](const std::string& sizes, int points, const std::string& data) {
    return pcdHeader("x y z", sizes, "F F F", "1 1 1", points, data);
  };
  expectRefused(folder, "a.pcd", pcd("4 4 3", 1, "binary"), "field 'z' has TYPE F, SIZE 3");
  expectRefused(folder, "b.pcd", pcd("4 4 4", 0, "binary"), "no points");
  expectRefused(folder, "c.pcd", pcd("4 4 4", 2'000'000'000, "binary"), "room for 0");
  expectRefused(folder, "d.pcd", pcd("4 4 4", 2'000'000'000, "ascii") + "1 2 3\n", "promises");
  expectRefused(folder, "e.pcd", pcd("4 4 4", 1, "zipped"), "'zipped' is not known");
  expectRefused(folder, "f.pcd", pcd("4 4", 1, "ascii") + "1 2 3\n", "of the same length");
  expectRefused(folder, "g.pcd", "# .PCD v0.7\n", "no line 'DATA'");
  expectRefused(folder, "h.pcd", "# .PCD v0.7\nCAKE 1\n", "line 2: 'CAKE'");
  expectRefused(folder, "i.pcd", "# .PCD v0.7\nWIDTH many\n", "line 2: 'many'");
  expectRefused(folder, "j.pcd", pcd("4 4 4", 1, "ascii") + "1 2 x\n", "line 12: 'x'");
  expectRefused(folder, "k.pcd", pcd("4 4 4", 1, "ascii") + "1 2 3\n4 5 6\n", "more lines");
  std::string contradiction = pcd("4 4 4", 1, "ascii") + "1 2 3\n";
  contradiction.replace(contradiction.find("WIDTH 1"), 7, "WIDTH 2");
  expectRefused(folder, "l.pcd", contradiction, "contradicts itself");
}

TEST(KittiBin, ReadsPointsAndRefusesOddSizes) {
  const test::TempDir folder;
  std::string bytes;
  for (int i = 0; i < 10; ++i) {
    for (const float v : {1.0F, 2.0F, static_cast<float>(i), 0.5F}) put(bytes, v);
  }
  const PointCloud cloud = loadCloud(folder.write("000000.bin", bytes));
  ASSERT_EQ(cloud.size(), 10U);
  EXPECT_EQ(cloud.points[9].z, 9.0F);
  EXPECT_EQ(cloud.intensity[3], 0.5F);
  expectRefused(folder, "odd.bin", bytes.substr(1), "no whole number of KITTI points");
}

}  // namespace
}  // namespace paloc

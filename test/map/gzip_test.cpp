#include <gtest/gtest.h>
#include <zlib.h>

#include <random>

#include "cloud_files.h"
#include "gzipped.h"

namespace paloc {
namespace {

using test::expectRefused;
using test::gzipped;
using test::pointOf;
using test::refusal;

std::string text(int points) {
  std::string lines;
  for (int i = 0; i < points; ++i) lines += std::to_string(i) + " 2 0.5\n";
  return lines;
}

TEST(Gzip, ReadsWhatIsInIt) {
  const test::TempDir folder;
  PointCloud cloud;
  std::mt19937 random(1);
  std::uniform_real_distribution<float> uniform(-50, 50);
  for (int i = 0; i < 1'000'000; ++i) {  // 12 MB: more than one piece
    cloud.points.push_back({uniform(random), uniform(random), uniform(random)});
  }
  savePly(folder / "a.ply", cloud);
  const std::string ply = test::readFile(folder / "a.ply");
  const PointCloud back = loadCloud(folder.write("a.ply.gz", gzipped(ply)));
  ASSERT_EQ(back.size(), cloud.size());
  EXPECT_EQ(std::memcmp(back.points.data(), cloud.points.data(), 12 * cloud.size()), 0);
  EXPECT_EQ(back.format, "PLY, binary_little_endian, gzipped");
  // Told by its first bytes, whatever it is called.
  EXPECT_EQ(loadCloud(folder.write("b.ply", gzipped(ply))).size(), cloud.size());
  const PointCloud xyz = loadCloud(folder.write("c.XYZ.GZ", gzipped(text(100))));
  EXPECT_EQ(pointOf(xyz, 99), Vec3(99, 2, 0.5));
  // Members one after the other, and zeros that pad the last.
  const std::string two = gzipped(text(50)) + gzipped(text(70)) + std::string(512, '\0');
  EXPECT_EQ(loadCloud(folder.write("d.xyz.gz", two)).size(), 120U);
}

TEST(Gzip, RefusesWhatIsBroken) {
  const test::TempDir folder;
  const std::string good = gzipped(text(10'000));
  expectRefused(folder, "a.xyz.gz", gzipped(""), "its gzip data holds nothing");
  expectRefused(folder, "b.xyz.gz", "", "is empty");
  expectRefused(folder, "c.xyz.gz", good.substr(0, good.size() / 2), "is cut off at byte");
  expectRefused(folder, "d.xyz.gz", good.substr(0, good.size() - 1), "is cut off at byte");
  expectRefused(folder, "e.xyz.gz", good.substr(0, 5), "is cut off at byte 5");
  expectRefused(folder, "f.xyz.gz", good + "garbage", "is damaged near byte");
  expectRefused(folder, "g.xyz.gz", gzipped(good), "is gzipped twice");
  std::string damaged = good;
  damaged[good.size() / 2] = static_cast<char>(damaged[good.size() / 2] ^ 0x10);
  expectRefused(folder, "h.xyz.gz", damaged, "is damaged near byte");
  expectRefused(folder, "i.gz", good, "is no point cloud in a format that is known");
  std::string wrong_sum = good;
  wrong_sum[good.size() - 6] = static_cast<char>(wrong_sum[good.size() - 6] ^ 1);
  expectRefused(folder, "j.xyz.gz", wrong_sum, "is damaged near byte");
}

TEST(Gzip, ABombIsRefusedBeforeItsMemoryIsTaken) {
  const test::TempDir folder;
  const auto bomb = folder.write("bomb.xyz.gz", gzipped(std::string(100 << 20, '1')));
  EXPECT_LT(std::filesystem::file_size(bomb), 500'000U);
  const std::string sentence = refusal(bomb, {.memory_limit_bytes = 20 << 20});
  EXPECT_NE(sentence.find("its unpacked content needs 0.03 GB of memory, but the limit is 0.02 GB"),
            std::string::npos)
      << sentence;
}

}  // namespace
}  // namespace paloc

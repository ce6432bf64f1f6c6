#include <gtest/gtest.h>

#include "cloud_files.h"

namespace paloc {
namespace {

using test::expectRefused;
using test::pointOf;

PointCloud read(const std::string& content, const std::string& name = "a.xyz") {
  const test::TempDir folder;
  return loadCloud(folder.write(name, content));
}

TEST(Xyz, ReadsAnySeparatorWithAndWithoutNames) {
  for (const std::string& content : {
           std::string("1 2 3 7\n4 5 6 8\n"),
           std::string("# a comment\n\n1,2,3,7\r\n4,5,6,8"),
           std::string("1;2; 3;7\n// in between\n4;5;6;8\n\n"),
           std::string("1\t2\t3\t7\n  4\t5 6\t8\n"),
           std::string("X Y Z Intensity\n1 2 3 7\n4 5 6 8\n"),
           std::string("//X,Y,Z,Scalar_Intensity\n1,2,3,7\n4,5,6,8\n"),
           std::string("intensity;\"z [m]\";y(m);x\n7;3;2;1\n8;6;5;4\n"),
           std::string("2\n1 2 3 7 255 0 0\n4 5 6 8 0 255 0\n"),
           std::string("r,g,b,x,y,z,i\n0,0,0,1,2,3,7\n9,9,9,4,5,6,8\n"),
       }) {
    const PointCloud cloud = read(content, content[1] == ',' ? "a.csv" : "a.txt");
    ASSERT_EQ(cloud.size(), 2U) << content;
    EXPECT_EQ(pointOf(cloud, 0), Vec3(1, 2, 3)) << content;
    EXPECT_EQ(pointOf(cloud, 1), Vec3(4, 5, 6)) << content;
    EXPECT_EQ(cloud.intensity, (std::vector<float>{7, 8})) << content;
    EXPECT_EQ(cloud.format, "XYZ text");
  }
}

TEST(Xyz, KeepsMillimetresOfUtmCoordinatesAndCountsWhatIsNotFinite) {
  std::string content;
  for (int i = 0; i < 10'000; ++i) {
    content += "512345." + std::to_string(100 + i % 900) + " 5403210.25 1e2\n";
  }
  const PointCloud cloud = read(content + "nan 1 2\n");
  ASSERT_EQ(cloud.size(), 10'000U);
  EXPECT_EQ(cloud.nonfinite_dropped, 1U);
  EXPECT_TRUE(cloud.intensity.empty());
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const Vec3 expected(512345 + 0.001 * static_cast<double>(100 + i % 900), 5403210.25, 100);
    ASSERT_LT((pointOf(cloud, i) - expected).norm(), 1e-4);
  }
}

TEST(Xyz, NamesTheLineThatIsWrong) {
  const test::TempDir folder;
  expectRefused(folder, "a.xyz", "1 2 3\n4 5\n", "line 2: has fewer than 3 values");
  expectRefused(folder, "b.xyz", "# x\n1 2 3\n4 5 6 7\n", "line 3: has more than 3 values");
  expectRefused(folder, "c.csv", "x,y,z\n1,2,3\n4,five,6\n",
                "line 3: 'five' is not a number (field 'y')");
  expectRefused(folder, "d.xyz", "1,5;2,5;3,5\n", "line 1: has commas and semicolons");
  expectRefused(folder, "e.txt", "hello world\n", "line 1: begins with 'hello'");
  expectRefused(folder, "f.txt", "# nothing\n\n", "no points");
  expectRefused(folder, "g.xyz", "1 2\n", "line 1: has 2 values");
  expectRefused(folder, "h.pts", "3\n1 2 3\n4 5 6\n", "promises 3 points, but it holds 2");
  expectRefused(folder, "i.pts", "1\n1 2 3\n4 5 6\n", "promises 1 points, but it holds 2");
  expectRefused(folder, "j.xyz", "nan 2 3\n", "none of its 1 points is finite");
  expectRefused(folder, "k.xyz", std::string(3'000'000, '7'), "line 1 is longer than");
  expectRefused(folder, "l.asc", "easting,northing,height\n1,2,3\n", "names no columns x, y and z");
  expectRefused(folder, "m.xyz", "1 2 3\n\n4 5 6x\n", "line 3: '6x' is not a number (field 'z')");
}

}  // namespace
}  // namespace paloc

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "cloud_files.h"
#include "run_program.h"

namespace paloc {
namespace {

using test::pointOf;
using test::runPaloc;

// Points 1 cm apart along x, at UTM coordinates.
std::string xyzFile(int points) {
  std::string content = "x,y,z,intensity\n";
  for (int i = 0; i < points; ++i) {
    char line[80];
    std::snprintf(line, sizeof line, "%.3f,5403210.125,250.5,%d\n", 512345 + 0.01 * i, i % 100);
    content += line;
  }
  return content;
}

TEST(MapConvert, WritesWhatItReadInAnyFormat) {
  const test::TempDir folder;
  const std::string in = folder.write("in.csv", xyzFile(5000)).string();
  const PointCloud original = loadCloud(in);
  for (const char* name : {"out.ply", "out.PCD"}) {
    const std::string out = (folder / name).string();
    const auto run = runPaloc({"map", "convert", in, out, "--json"});
    ASSERT_EQ(run.exit_code, 0) << run.err;
    const auto json = nlohmann::json::parse(run.out);
    EXPECT_EQ(json["points_read"], 5000);
    EXPECT_EQ(json["points_written"], 5000);
    EXPECT_EQ(json["format"], "XYZ text");
    const PointCloud cloud = loadCloud(out);
    ASSERT_EQ(cloud.size(), original.size());
    for (std::size_t i = 0; i < cloud.size(); ++i) {
      ASSERT_LT((pointOf(cloud, i) - pointOf(original, i)).norm(), 2e-5);
      ASSERT_EQ(cloud.intensity[i], original.intensity[i]);
    }
  }
  const std::string thin = (folder / "thin.ply").string();
  EXPECT_EQ(runPaloc({"map", "convert", in, thin, "--voxel", "0.5"}).exit_code, 0);
  EXPECT_NEAR(static_cast<double>(loadCloud(thin).size()), 100, 2);
}

TEST(MapConvert, ReplacesNothingUnlessAsked) {
  const test::TempDir folder;
  const std::string in = folder.write("in.xyz", "1 2 3\n4 5 6\n").string();
  const std::string out = folder.write("out.ply", "precious").string();
  const auto refused = runPaloc({"map", "convert", in, out});
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_NE(refused.err.find("--overwrite"), std::string::npos) << refused.err;
  EXPECT_EQ(test::readFile(out), "precious");
  EXPECT_EQ(runPaloc({"map", "convert", in, out, "--overwrite"}).exit_code, 0);
  EXPECT_EQ(loadCloud(out).size(), 2U);
  EXPECT_EQ(runPaloc({"map", "convert", out, out, "--overwrite"}).exit_code, 2);
  EXPECT_EQ(runPaloc({"map", "convert", in, (folder / "out.las").string()}).exit_code, 2);
  EXPECT_EQ(runPaloc({"map", "convert", "nothing.xyz", (folder / "a.ply").string()}).exit_code, 3);
  EXPECT_FALSE(std::filesystem::exists(folder / "a.ply"));
}

}  // namespace
}  // namespace paloc

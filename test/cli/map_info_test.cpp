#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "paloc/map/cloud_io.h"
#include "run_program.h"
#include "temp_dir.h"

namespace paloc {
namespace {

using test::runPaloc;

// A floor and two walls, points every 10 cm, at UTM coordinates.
PointCloud corner() {
  PointCloud cloud;
  cloud.origin = Vec3(500'000, 5'400'000, 100);
  for (int i = 0; i < 50; ++i) {
    for (int k = 0; k < 50; ++k) {
      const float a = 0.1F * static_cast<float>(i), b = 0.1F * static_cast<float>(k);
      for (const Point3f& p : {Point3f{a, b, 0}, Point3f{a, 0, b}, Point3f{0, a, b}}) {
        cloud.points.push_back(p);
        cloud.intensity.push_back(1);
      }
    }
  }
  return cloud;
}

TEST(MapInfo, TellsWhatAMapHolds) {
  const test::TempDir folder;
  const auto file = folder / "corner.ply";
  savePly(file, corner());
  const auto run = runPaloc({"map", "info", file.string(), "--json"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const auto info = nlohmann::json::parse(run.out);
  EXPECT_EQ(info["format"], "PLY, binary_little_endian");
  EXPECT_EQ(info["points"], 7500);
  EXPECT_EQ(info["nonfinite"], 0);
  EXPECT_EQ(info["intensity"], true);
  EXPECT_NEAR(info["spacing_m"].get<double>(), 0.1, 1e-4);
  EXPECT_NEAR(info["low_m"][1].get<double>(), 5'400'000, 1e-3);
  EXPECT_NEAR(info["high_m"][2].get<double>(), 104.9, 1e-3);
  EXPECT_EQ(info["origin_m"][0].get<double>(), 500'000);
  EXPECT_GT(info["planar_share"].get<double>(), 0.7);
  EXPECT_GT(info["memory_mb"].get<double>(), 0.1);
  const auto table = runPaloc({"map", "info", file.string()});
  EXPECT_EQ(table.exit_code, 0);
  EXPECT_NE(table.out.find("7500 finite"), std::string::npos) << table.out;
}

TEST(MapInfo, RefusesInOneSentence) {
  const test::TempDir folder;
  const auto broken = folder.write("broken.ply", "ply\nformat ascii 1.0\nend_header\n");
  for (const std::string& file : {broken.string(), (folder / "missing.ply").string()}) {
    const auto run = runPaloc({"map", "info", file});
    EXPECT_EQ(run.exit_code, 3) << run.err;
    EXPECT_EQ(std::count(run.err.begin(), run.err.end(), '\n'), 1) << run.err;
  }
  EXPECT_EQ(runPaloc({"map"}).exit_code, 2);
  EXPECT_EQ(runPaloc({"map", "info"}).exit_code, 2);
}

}  // namespace
}  // namespace paloc

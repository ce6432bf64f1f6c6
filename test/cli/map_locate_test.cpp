#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "paloc/core/mrpt_pose.h"
#include "paloc/frontends/tum_file.h"
#include "paloc/map/cloud_io.h"
#include "replay_demo.h"

namespace paloc {
namespace {

using test::demoFolder;
using test::demoMap;
using test::runPaloc;

/// The demo's first scan, taken at rest, in the body's frame, and where the body is.
class ReplayMapLocate : public testing::Test {
 protected:
  void SetUp() override {
    savePcd(scan_, test::firstScan(test::demoLog()));
    truth_ = readTum(demoFolder() / "truth.tum").front().pose;
  }

  test::ProgramRun locate(const test::Words& more) const {
    test::Words words = {"map", "locate", scan_, "--map", demoMap()};
    words.insert(words.end(), more.begin(), more.end());
    return runPaloc(words);
  }
  void expectFound(const test::Words& more) const {
    test::Words words = more;
    words.emplace_back("--json");
    const auto run = locate(words);
    ASSERT_EQ(run.exit_code, 0) << run.err << run.out;
    const auto json = nlohmann::json::parse(run.out);
    EXPECT_TRUE(json.at("found").get<bool>());
    const auto& pose = json.at("pose");
    const Vec3 position(pose.at("x_m"), pose.at("y_m"), pose.at("z_m"));
    EXPECT_LT((position - truth_.position).norm(), 0.03);
    EXPECT_NEAR(std::remainder(pose.at("yaw_deg").get<double>() * M_PI / 180 - toMrpt(truth_).yaw(),
                               2 * M_PI),
                0, 0.01);
    ASSERT_EQ(json.at("covariance").size(), 6U);
    for (std::size_t k = 0; k < 6; ++k) {
      const double variance = json.at("covariance")[k].at(k);
      EXPECT_GT(variance, 0);
      EXPECT_LT(variance, 1e-3);
    }
    ASSERT_EQ(json.at("directions").size(), 6U);
    EXPECT_EQ(json.at("directions")[0].at("class"), "full");
  }
  std::string near(const Vec3& off, double yaw_deg) const {
    const Vec3 at = truth_.position + off;
    const double yaw = toMrpt(truth_).yaw() * 180 / M_PI + yaw_deg;
    return std::to_string(at.x()) + ',' + std::to_string(at.y()) + ',' + std::to_string(at.z()) +
           ',' + std::to_string(yaw) + ",0,0";
  }

  test::TempDir dir_;
  std::filesystem::path scan_ = dir_ / "scan.pcd";
  Pose truth_;
};

TEST_F(ReplayMapLocate, FindsAScanFromARoughPoseAPositionAndNothing) {
  expectFound({"--init-pose=" + near(Vec3(0.5, 0.3, 0), 5)});
  expectFound({"--init-pose=" + near(Vec3(2, -2, 0.5), -40)});
  const Vec3 at = truth_.position + Vec3(0.3, 0.3, 0.1);
  expectFound({"--init-position=" + std::to_string(at.x()) + ',' + std::to_string(at.y()) + ',' +
               std::to_string(at.z())});
  expectFound({"--init", "auto"});
  const auto table = locate({"--init", "auto"});
  EXPECT_EQ(table.exit_code, 0);
  EXPECT_NE(table.out.find("found in "), std::string::npos) << table.out;
  EXPECT_NE(table.out.find("full"), std::string::npos) << table.out;
}

// Half of a scan turned over is the scan of no place.
TEST_F(ReplayMapLocate, TellsWhyItDoesNotFindAScan) {
  PointCloud cloud = loadCloud(scan_);
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    if (cloud.points[i].x > 0) cloud.points[i].y *= -2;
  }
  savePcd(scan_, cloud);
  const auto run = locate({"--init", "auto", "--json"});
  EXPECT_EQ(run.exit_code, 4) << run.out;
  const auto json = nlohmann::json::parse(run.out);
  EXPECT_FALSE(json.at("found").get<bool>());
  EXPECT_TRUE(json.at("pose").is_null());
  EXPECT_FALSE(json.at("reason").get<std::string>().empty());
  const auto table = locate({"--init", "auto"});
  EXPECT_EQ(table.exit_code, 4);
  EXPECT_NE(table.out.find("not localized"), std::string::npos) << table.out;
}

TEST_F(ReplayMapLocate, WrongUsageAndWrongFilesAreTold) {
  EXPECT_EQ(locate({}).exit_code, 2);
  EXPECT_NE(locate({}).err.find("--init"), std::string::npos);
  EXPECT_EQ(locate({"--init", "somewhere"}).exit_code, 2);
  EXPECT_EQ(locate({"--init-position=1,2"}).exit_code, 2);
  EXPECT_EQ(locate({"--init-position=1,2,3", "--init", "auto"}).exit_code, 2);
  EXPECT_EQ(locate({"--init-pose=1,2,3"}).exit_code, 2);
  EXPECT_EQ(
      runPaloc({"map", "locate", dir_ / "no.pcd", "--map", demoMap(), "--init", "auto"}).exit_code,
      3);
  EXPECT_EQ(
      runPaloc({"map", "locate", scan_, "--map", dir_ / "no.ply", "--init", "auto"}).exit_code, 3);
}

}  // namespace
}  // namespace paloc

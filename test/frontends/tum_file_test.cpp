#include "paloc/frontends/tum_file.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <string>

#include "paloc/core/errors.h"
#include "paloc/core/so3.h"

namespace paloc {
namespace {

class TumFile : public testing::Test {
 protected:
  void SetUp() override {
    const auto* info = testing::UnitTest::GetInstance()->current_test_info();
    folder_ = std::filesystem::temp_directory_path() / (std::string("paloc_tum_") + info->name());
    std::filesystem::remove_all(folder_);
    std::filesystem::create_directories(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  std::filesystem::path write(const std::string& text) const {
    const auto file = folder_ / "a.tum";
    std::ofstream(file, std::ios::binary) << text;
    return file;
  }
  std::string refusalOf(const std::string& text) const {
    const auto file = write(text);
    try {
      readTum(file);
    } catch (const IoError& e) {
      return e.what();
    }
    return "";
  }

  std::filesystem::path folder_;
};

TEST_F(TumFile, ReadsStampsToTheNanosecondAndKeepsTheOrder) {
  const auto poses =
      readTum(write("# t x y z qx qy qz qw\r\n"
                    "1645002364.537699938 1 -2 3e-1 0 0 0 1\r\n"
                    "\n"
                    "  1645002364.1\t0 0 0 0 0 0.70710678 0.70710678  # a comment\n"
                    "5 +1 2 3 0 0 0 -1"));
  ASSERT_EQ(poses.size(), 3U);
  EXPECT_EQ(poses[0].t_ns, 1645002364537699938);
  EXPECT_EQ(poses[1].t_ns, 1645002364100000000);
  EXPECT_EQ(poses[2].t_ns, 5 * kNsPerSecond);
  EXPECT_EQ(poses[0].pose.position, Vec3(1, -2, 0.3));
  const Vec3 w = so3::log(poses[1].pose.rotation);
  EXPECT_NEAR((w - Vec3(0, 0, std::numbers::pi / 2)).norm(), 0, 1e-12);
  EXPECT_NEAR((poses[2].pose.rotation - Mat3::Identity()).norm(), 0, 1e-15);
}

TEST_F(TumFile, ComesBackAsItWasWritten) {
  std::vector<StampedPose> poses;
  for (int i = 0; i < 200; ++i) {
    const Vec3 w(std::sin(i), std::cos(3.0 * i), 0.02 * i - 2);
    poses.push_back({1645002364000000001 + i * 99'999'999LL,
                     {Vec3(0.37 * i, -1.1 * i, 1e-5 * i), so3::exp(w)}});
  }
  const auto file = folder_ / "b.tum";
  writeTum(file, poses);
  const auto back = readTum(file);
  ASSERT_EQ(back.size(), poses.size());
  for (std::size_t i = 0; i < poses.size(); ++i) {
    EXPECT_EQ(back[i].t_ns, poses[i].t_ns);
    EXPECT_LT((back[i].pose.position - poses[i].pose.position).norm(), 1e-9);
    EXPECT_LT(so3::log(back[i].pose.rotation.transpose() * poses[i].pose.rotation).norm(), 3e-9);
  }
}

TEST_F(TumFile, LineHasOneForm) {
  EXPECT_EQ(tumLine({1'000'000'002, {Vec3(1, -1e-12, 1.0 / 3), Mat3::Identity()}}),
            "1.000000002 1.000000000 0.000000000 0.333333333 0.000000000 0.000000000 0.000000000 "
            "1.000000000");
  EXPECT_EQ(tumLine({-1'500'000'000, {}}).substr(0, 13), "-1.500000000 ");
  EXPECT_EQ(tumLine({-5, {}}).substr(0, 13), "-0.000000005 ");
  // A turn by more than pi has a negative w in one of its two quaternions: never that one.
  const StampedPose turned{0, {Vec3::Zero(), so3::exp(Vec3(0, 0, 3.5))}};
  const std::string line = tumLine(turned);
  EXPECT_EQ(line.substr(line.rfind(' ') + 1), "0.178246056");
}

TEST_F(TumFile, RefusalsNameFileLineAndField) {
  const std::string good = "1 0 0 0 0 0 0 1\n";
  EXPECT_NE(refusalOf(good + "2 0 0 0 0 0 0\n").find("a.tum:2: a TUM line has 8 fields"),
            std::string::npos);
  EXPECT_NE(refusalOf(good + "2 0 0 0 0 0 0 1 9\n").find("this one has 9"), std::string::npos);
  EXPECT_NE(refusalOf(good + "2 0 nan 0 0 0 0 1\n").find("a.tum:2: field y"), std::string::npos);
  EXPECT_NE(refusalOf(good + "2 0 0 1,5 0 0 0 1\n").find("\"1,5\""), std::string::npos);
  EXPECT_NE(refusalOf(good + "2s 0 0 0 0 0 0 1\n").find("field t"), std::string::npos);
  EXPECT_NE(refusalOf("2 0 0 0 0 0 0 0\n").find("length"), std::string::npos);
  EXPECT_NE(refusalOf("2 0 0 0 90 0 0 1\n").find("length"), std::string::npos);
  EXPECT_NE(refusalOf("# only a comment\n").find("holds no pose"), std::string::npos);
  EXPECT_NE(refusalOf("").find("holds no pose"), std::string::npos);
  EXPECT_THROW(readTum(folder_ / "absent.tum"), IoError);
  EXPECT_THROW(readTum(folder_), IoError);
}

TEST_F(TumFile, UnwritableTargetIsSaid) {
  EXPECT_THROW(writeTum(folder_ / "no" / "such.tum", {{0, {}}}), IoError);
  if (std::filesystem::exists("/dev/full")) {
    EXPECT_THROW(writeTum("/dev/full", {{0, {}}}), IoError);
  }
}

}  // namespace
}  // namespace paloc

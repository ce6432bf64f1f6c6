#include "paloc/tools/bench_corridor.h"

#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>

#include "paloc/core/errors.h"
#include "paloc/core/so3.h"

namespace paloc {
namespace {

/// A straight way of 40 m along an axis, an error of `along` at its end that grows with the way
/// inside [10, 30], and one of `left` all the way.
std::vector<CorridorPose> straightWay(const Vec3& axis, double along, double left) {
  std::vector<CorridorPose> poses;
  for (int i = 0; i <= 400; ++i) {
    const double x = 0.1 * i;
    CorridorPose p;
    p.t_ns = i * kNsPerSecond / 10;
    p.truth.position = x * axis;
    const double grown = x < 10 || x > 30 ? 0 : (x - 10) / 20;
    p.estimate.position =
        p.truth.position + grown * along * axis + left * Vec3::UnitZ().cross(axis);
    p.covariance.topLeftCorner<3, 3>() =
        1e-4 * Mat3::Identity() + (0.04 * 0.04 - 1e-4) * axis * axis.transpose();
    p.flag = grown > 0 ? PoseFlag::kDegenerate : PoseFlag::kGood;
    poses.push_back(p);
  }
  return poses;
}

TEST(CorridorFigures, TellAlongFromAcross) {
  const Vec3 axis(std::cos(0.5), std::sin(0.5), 0);
  const FreeStretch stretch{axis, 10.05, 29.95};
  const CorridorFigures f = corridorFigures(straightWay(axis, 0.2, 0.01), stretch);
  EXPECT_NEAR(f.along_at_end_m, 0.199, 1e-9);
  EXPECT_NEAR(f.along_max_m, 0.199, 1e-9);
  EXPECT_NEAR(f.across_max_m, 0.01, 1e-9);
  EXPECT_NEAR(f.across_rms_m, 0.01, 1e-9);
  EXPECT_NEAR(f.along_max_sigmas, 5, 0.01);  // the last pose at 30 m: 0.2 over 0.04
  EXPECT_NEAR(f.nees_along, 25.0 / 3, 0.2);  // of a line from 0 to 5 sigmas
  EXPECT_NEAR(f.nees_across, 0.5, 1e-6);     // 1 sigma to the left, none up
  EXPECT_NEAR(f.exit_step_m, 0.2, 1e-6);     // all of it goes at once
  EXPECT_EQ(f.poses, 199U);
  EXPECT_EQ(f.inside[static_cast<std::size_t>(PoseFlag::kDegenerate)], 199U);
  EXPECT_EQ(f.outside[static_cast<std::size_t>(PoseFlag::kGood)], 201U);
}

TEST(CorridorFigures, OdometryDriftsFromTheStretchsBeginningOn) {
  const FreeStretch stretch{Vec3::UnitX(), 10, 30};
  std::vector<Pose> truth, odometry;
  for (int i = 0; i <= 400; ++i) {
    truth.push_back({Vec3(0.1 * i + 1e-6, 0, 0), Mat3::Identity()});
    // Its own frame: begins elsewhere and is turned.
    const Pose T_odom_map{Vec3(3, -2, 1), so3::exp(Vec3(0, 0, 1))};
    odometry.push_back(T_odom_map * Pose{Vec3(0.101 * i, 0, 0), Mat3::Identity()});
  }
  EXPECT_NEAR(odometryDrift(truth, odometry, stretch), 0.01 * 19.9, 1e-6);
}

/// Short, and a coarse survey.
BenchCorridorSettings small(double angle_deg, std::uint64_t seed) {
  BenchCorridorSettings settings;
  settings.free_m = 20;
  settings.angle_deg = angle_deg;
  settings.sensor = "vlp-16";
  settings.seed = seed;
  settings.survey.spacing_m = 0.05;
  settings.survey.angular_step_deg = 0.4;
  return settings;
}

double shareDegenerate(const CorridorFigures& f) {
  return static_cast<double>(f.inside[static_cast<std::size_t>(PoseFlag::kDegenerate)]) /
         static_cast<double>(f.poses);
}

class BenchCorridor : public testing::TestWithParam<double> {};

TEST_P(BenchCorridor, GoesThroughOnOdometryAlongAndOnTheMapAcross) {
  double share = 0;
  const BenchCorridorResult result =
      benchCorridor(small(GetParam(), 2), {}, [&](double s) { share = s; });
  EXPECT_EQ(share, 1);
  const double drift_m = result.odometry_drift_m;
  EXPECT_NEAR(drift_m, 0.1, 0.07);  // half a percent of 20 m, and noise
  const CorridorFigures &online = result.handled.online, &batch = result.handled.batch;
  EXPECT_GT(online.poses, 150U);
  EXPECT_EQ(batch.poses, online.poses);
  EXPECT_LE(online.along_at_end_m, 1.2 * drift_m + 0.01);
  EXPECT_LE(batch.along_max_m, drift_m / 2);
  for (const CorridorFigures* f : {&online, &batch}) {
    EXPECT_LE(f->across_max_m, 0.015);
    EXPECT_LE(f->along_max_sigmas, 3.5);
    EXPECT_LE(f->nees_along, 3);
    // Not all: where a single ring happens to run along the lintel of the far room, its points are
    // taken for the wall above, and that scan alone calls the axis fixed.
    EXPECT_GE(shareDegenerate(*f), 0.99);
    EXPECT_EQ(f->inside[static_cast<std::size_t>(PoseFlag::kLost)], 0U);
  }
  EXPECT_LE(batch.exit_step_m, 0.02);
  EXPECT_LT(result.handled.refused, result.scans / 50);
}

INSTANTIATE_TEST_SUITE_P(Angle, BenchCorridor, testing::Values(0.0, 45.0));

TEST(BenchCorridorOutput, HoldsBothRunsAndTheTargets) {
  BenchCorridorSettings settings = small(0, 1);
  settings.free_m = 5;
  const BenchCorridorResult result = benchCorridor(settings, {}, [](double) {});
  const auto json = jsonOf(result);
  EXPECT_TRUE(json.at("handled").at("degeneracy_handling"));
  EXPECT_FALSE(json.at("unhandled").at("degeneracy_handling"));
  EXPECT_EQ(json.at("targets").size(), result.targets().size());
  EXPECT_NE(tableOf(result).find("not handled"), std::string::npos);
  const std::string csv = posesCsv(result);
  const auto rows = static_cast<std::size_t>(std::count(csv.begin(), csv.end(), '\n'));
  EXPECT_EQ(rows, 1 + 2 * (result.handled.batch_poses.size() + result.handled.online_poses.size()));
  settings.sensor = "sonar";
  EXPECT_THROW(benchCorridor(settings, {}, [](double) {}), UsageError);
}

}  // namespace
}  // namespace paloc

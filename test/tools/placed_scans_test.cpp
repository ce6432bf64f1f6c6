#include "paloc/tools/placed_scans.h"

#include <gtest/gtest.h>

#include "paloc/core/mrpt_pose.h"

namespace paloc {
namespace {

// Two scans, 1 m apart, with points of two ages.
ScanMap twoScans(bool keep_ages) {
  ScanMap scans(keep_ages);
  for (int i = 0; i < 2; ++i) {
    auto scan = std::make_shared<Scan>();
    scan->points_body = {{5, 0, 0}, {0, 2, 1}};
    scan->ages_s = {0.1F, 0};
    scan->sensor_position_body = Vec3(0, 0, 0.5);
    OdometryFrame frame;
    frame.t_ns = i * kNsPerSecond;
    frame.T_odom_body = toMrpt(Pose{Vec3(i, 0, 0), Mat3::Identity()});
    frame.scan = scan;
    scans.add(frame);
  }
  return scans;
}

std::vector<TrajectoryPoint> trajectory() {
  std::vector<TrajectoryPoint> points(2);
  for (int i = 0; i < 2; ++i) {
    TrajectoryPoint& p = points[static_cast<std::size_t>(i)];
    p.t_ns = i * kNsPerSecond;
    p.T_map_body = toMrpt(Pose{Vec3(100, 200 + i, 1), so3::exp(Vec3(0, 0, 1.5707963267948966))});
    p.v_map = Vec3(0, 1.5, 0);
    p.covariance = 1e-4 * Mat6::Identity();
    p.covariance(1, 1) = 4e-4;
    p.flag = PoseFlag::kGood;
  }
  return points;
}

void expectAt(const Point3f& p, float x, float y, float z) {
  EXPECT_NEAR(p.x, x, 1e-4F);
  EXPECT_NEAR(p.y, y, 1e-4F);
  EXPECT_NEAR(p.z, z, 1e-4F);
}

TEST(PlacedScans, RaysBeginWhereTheSensorWasAndAreRelativeToTheOrigin) {
  const ScanMap scans = twoScans(true);
  const auto poses = trajectory();
  const PlacedScans placed(scans, poses, Vec3(100, 200, 0));
  ASSERT_EQ(placed.size(), 2U);
  const ScanRays rays = placed.rays(0);
  ASSERT_EQ(rays.to.size(), 2U);
  ASSERT_EQ(rays.from.size(), 2U);
  expectAt(rays.to[0], 0, 5, 1);
  expectAt(rays.to[1], -2, 0, 2);
  expectAt(rays.from[0], 0, -0.15F, 1.5F);  // a tenth of a second before the scan's end
  expectAt(rays.from[1], 0, 0, 1.5F);
  EXPECT_NEAR(rays.position_sigma_m, 0.02, 1e-9);
  EXPECT_NEAR(rays.rotation_sigma_rad, 0.01, 1e-9);
  EXPECT_EQ(placed.rays(1).t_ns, kNsPerSecond);
}

TEST(PlacedScans, WithoutAgesRaysBeginAtTheScansEnd) {
  const ScanMap scans = twoScans(false);
  const auto poses = trajectory();
  const ScanRays rays = PlacedScans(scans, poses, Vec3(100, 200, 0)).rays(0);
  expectAt(rays.from[0], 0, 0, 1.5F);
}

TEST(PlacedScans, LostPosesAndScansWithoutAPoseStayOut) {
  const ScanMap scans = twoScans(true);
  auto poses = trajectory();
  poses[0].flag = PoseFlag::kLost;
  EXPECT_EQ(PlacedScans(scans, poses, Vec3::Zero()).size(), 1U);
  poses.pop_back();
  EXPECT_EQ(PlacedScans(scans, poses, Vec3::Zero()).size(), 0U);
}

}  // namespace
}  // namespace paloc

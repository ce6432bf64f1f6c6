#include "paloc/frontends/free_fall_scan.h"

#include <gtest/gtest.h>

#include "box_world.h"

namespace paloc {
namespace {

constexpr TimeNs kStart = 2 * kNsPerSecond, kEnd = kStart + 100'000'000;
constexpr double kGravity = 9.81;  // m/s2

ImuBuffer imuOn(const test::Path& path) {
  ImuBuffer imu;
  for (TimeNs t = kStart - 10'000'000; t <= kEnd + 10'000'000; t += 2'500'000) {
    imu.add(test::imuOnPath(path, t, kGravity));
  }
  return imu;
}

TEST(FreeFallScan, PutsPointsOfAMovingBodyWhereTheyAre) {
  const test::Path path = test::sway();
  const FreeFallScan scan(imuOn(path), kStart, kEnd, 0.05, Vec3::Zero(), Vec3::Zero());
  ASSERT_TRUE(scan.ok());
  const double end_s = static_cast<double>(kEnd) * 1e-9, h = 1e-5;
  const Pose T_odom_body = path(end_s);
  const Vec3 v = (path(end_s + h).position - path(end_s - h).position) / (2 * h);
  const Vec3 target(8, -3, 1);  // in the odom frame
  for (int i = 0; i <= 100; ++i) {
    const double tau = 0.001 * i;
    const Vec3 point_body = path(end_s - tau).inverse() * target;
    const Vec3 found =
        T_odom_body * scan.place(point_body, tau) - v * tau - Vec3(0, 0, kGravity * tau * tau / 2);
    EXPECT_LT((found - target).norm(), 5e-4) << tau;
    const Pose body = T_odom_body * scan.bodyAt(tau);
    EXPECT_LT(so3::log(body.rotation.transpose() * path(end_s - tau).rotation).norm(), 5e-5);
  }
}

TEST(FreeFallScan, IsTheIdentityAtTheEndAndWithoutADuration) {
  const ImuBuffer imu = imuOn(test::sway());
  const FreeFallScan scan(imu, kStart, kEnd, 0.05, Vec3::Zero(), Vec3::Zero());
  EXPECT_LT((scan.place(Vec3(1, 2, 3), 0) - Vec3(1, 2, 3)).norm(), 1e-9);
  const FreeFallScan instant(imu, kEnd, kEnd, 0.05, Vec3::Zero(), Vec3::Zero());
  EXPECT_TRUE(instant.ok());
  EXPECT_LT((instant.place(Vec3(1, 2, 3), 0) - Vec3(1, 2, 3)).norm(), 1e-12);
}

TEST(FreeFallScan, SaysWhereTheImuDoesNotCoverIt) {
  ImuBuffer imu;
  for (TimeNs t = kStart; t <= kStart + 40'000'000; t += 5'000'000) {
    imu.add({t, Vec3(0, 0, 9.8), Vec3::Zero()});
  }
  EXPECT_FALSE(FreeFallScan(imu, kStart, kEnd, 0.02, Vec3::Zero(), Vec3::Zero()).ok());
}

}  // namespace
}  // namespace paloc

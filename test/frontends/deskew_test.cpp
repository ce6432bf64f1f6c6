#include "paloc/frontends/deskew.h"

#include <gtest/gtest.h>

#include "box_world.h"
#include "paloc/core/mrpt_pose.h"
#include "paloc/frontends/lidar_decoder.h"

namespace paloc {
namespace {

using test::BoxRoom;
using test::Path;

constexpr TimeNs kStart = 2'000'000'000, kDuration = 100'000'000;
constexpr RangeLimits kNoLimits{0.01, 1000};
const Pose kLidarPose{Vec3(0.1, -0.05, 0.08), so3::exp(Vec3(0.02, 0.5, -1.2))};

LidarFrame scanAlong(const Path& path, const Pose& T_body_lidar = kLidarPose) {
  auto scan = test::scanRoom(BoxRoom{}, path, T_body_lidar, kStart, kDuration);
  scan.sensorPoseOnRobot = toMrpt(T_body_lidar);
  std::string refusal;
  auto frame = decodeLidar(scan, {}, refusal);
  EXPECT_TRUE(frame) << refusal;
  return *frame;
}

double seconds(TimeNs t_ns) { return static_cast<double>(t_ns) * 1e-9; }

// What is known of the scan's motion on a path: IMU at 200 Hz that does not fall on the scan's
// borders, odometry at its start and end.
ScanMotionInput known(const Path& path, bool imu, bool odometry) {
  ScanMotionInput input;
  input.start_ns = kStart;
  input.end_ns = kStart + kDuration;
  for (TimeNs t = kStart - 3'000'000; imu && t < kStart + kDuration + 5'000'000; t += 5'000'000) {
    input.imu.push_back(test::imuOnPath(path, t));
  }
  if (odometry) {
    for (const TimeNs t : {input.start_ns, input.end_ns}) {
      input.odometry.push_back({t, path(seconds(t))});
    }
  }
  input.up_body_end = path(seconds(input.end_ns)).rotation.transpose() * Vec3::UnitZ();
  return input;
}

double worstAfter(const Path& path, const ScanMotionInput& input) {
  DroppedPoints dropped;
  const Scan scan = deskew(scanAlong(path), ScanMotion(input), kNoLimits, dropped);
  EXPECT_EQ(scan.points_body.size(), 360U * 16U);
  EXPECT_EQ(scan.end_ns, kStart + kDuration);
  return test::worstOffWall(BoxRoom{}, path(seconds(scan.end_ns)), scan.points_body);
}

double worstUndeskewed(const Path& path) {
  DroppedPoints dropped;
  const Scan scan = placeOnBody(scanAlong(path), kNoLimits, dropped);
  return test::worstOffWall(BoxRoom{}, path(seconds(scan.end_ns)), scan.points_body);
}

TEST(Deskew, ConstantTwistByOdometryAlone) {
  const Path path = test::constantTwist(Vec3(0.4, -0.2, 0.05), Vec3(0.1, -0.2, 0.3));
  EXPECT_GT(worstUndeskewed(path), 0.02);
  EXPECT_LT(worstAfter(path, known(path, false, true)), 1e-4);
}

TEST(Deskew, ConstantTwistByImuAndOdometry) {
  const Path path = test::constantTwist(Vec3(0.4, -0.2, 0.05), Vec3(0.1, -0.2, 0.3));
  EXPECT_LT(worstAfter(path, known(path, true, true)), 1e-4);
}

TEST(Deskew, SwayingNeedsTheImu) {
  const Path path = test::sway();
  EXPECT_GT(worstUndeskewed(path), 0.1);
  const double by_odometry = worstAfter(path, known(path, false, true));
  const double by_imu = worstAfter(path, known(path, true, true));
  EXPECT_GT(by_odometry, 0.005) << "the path is no test if straight lines do";
  EXPECT_LT(by_imu, 3e-4);
}

TEST(Deskew, GravityTwoHundredthsRadiansOffCostsAQuarterMillimetre) {
  const Path path = test::sway();
  ScanMotionInput input = known(path, true, true);
  const Vec3 wrong = so3::exp(Vec3(0.02, 0, 0)) * input.up_body_end.value_or(Vec3::Zero());
  input.up_body_end = wrong;
  EXPECT_LT(worstAfter(path, input), 6e-4);
}

TEST(Deskew, WithoutOdometryByGyroscopeAndLastVelocity) {
  const Path path = test::sway();
  ScanMotionInput input = known(path, true, false);
  const double h = 1e-4, t = seconds(kStart);
  const Vec3 v_world = (path(t + h).position - path(t - h).position) / (2 * h);
  input.v_body_start = path(t).rotation.transpose() * v_world;
  EXPECT_LT(worstAfter(path, input), 5e-4);
  const ScanMotion motion(input);
  const double end = seconds(kStart + kDuration);
  const Vec3 v_end = (path(end + h).position - path(end - h).position) / (2 * h);
  ASSERT_TRUE(motion.vBodyEnd());
  EXPECT_LT((*motion.vBodyEnd() - path(end).rotation.transpose() * v_end).norm(), 0.01);
}

TEST(Deskew, WithTheGyroscopeAloneTheRotationIsUndone) {
  const Path path = test::constantTwist(Vec3::Zero(), Vec3(0.3, -0.2, 1.5));
  EXPECT_GT(worstUndeskewed(path), 0.2);
  const ScanMotionInput input = known(path, true, false);
  EXPECT_LT(worstAfter(path, input), 2e-4);
  EXPECT_FALSE(ScanMotion(input).vBodyEnd()) << "nothing tells the translation";
}

TEST(Deskew, MotionMeetsTheOdometryAtBothEnds) {
  const Path path = test::sway();
  const ScanMotionInput input = known(path, true, true);
  const ScanMotion motion(input);
  const Pose end = motion.bodyAt(input.end_ns), start = motion.bodyAt(input.start_ns);
  EXPECT_LT(boxminus(end, Pose{}).norm(), 1e-12);
  const Pose expected = path(seconds(input.end_ns)).inverse() * path(seconds(input.start_ns));
  EXPECT_LT((start.position - expected.position).norm(), 2e-4);
}

TEST(Deskew, FollowsEveryPoseOfAFastOdometry) {
  const Path path = test::sway();
  ScanMotionInput input = known(path, false, false);
  for (TimeNs t = kStart; t <= kStart + kDuration; t += 5'000'000) {
    input.odometry.push_back({t, path(seconds(t))});
  }
  EXPECT_LT(worstAfter(path, input), 5e-4);
}

TEST(Deskew, FastTurningStaysWithinTheBound) {
  const Path path = test::constantTwist(Vec3(1.5, 0, 0), Vec3(0, 0, 9.5));
  ScanMotionInput input = known(path, true, true);
  DroppedPoints dropped;
  const LidarFrame frame = scanAlong(path);
  const ScanMotion motion(input);
  const Scan scan = deskew(frame, motion, kNoLimits, dropped);
  double worst = 0;
  for (std::size_t i = 0; i < frame.points_lidar.size(); ++i) {
    const Point3f& p = frame.points_lidar[i];
    const Vec3 exact =
        motion.bodyAt(frame.stamp_ns + frame.dt_ns[i]) * (frame.T_body_lidar * Vec3(p.x, p.y, p.z));
    const Point3f& q = scan.points_body[i];
    worst = std::max(worst, (exact - Vec3(q.x, q.y, q.z)).norm());
  }
  EXPECT_LT(worst, 1e-4);
}

TEST(Deskew, RangeLimitsAreCounted) {
  const Path path = test::constantTwist(Vec3::Zero(), Vec3::Zero());
  const LidarFrame frame = scanAlong(path);
  std::size_t near = 0, far = 0;
  for (const Point3f& p : frame.points_lidar) {
    const double range = Vec3(p.x, p.y, p.z).norm();
    near += range < 2.5;
    far += range > 5;
  }
  ASSERT_GT(near, 0U);
  ASSERT_GT(far, 0U);
  DroppedPoints dropped;
  const Scan scan =
      deskew(frame, ScanMotion(known(path, true, true)), RangeLimits{2.5, 5.0}, dropped);
  EXPECT_EQ(dropped.too_near, near);
  EXPECT_EQ(dropped.too_far, far);
  EXPECT_EQ(scan.points_body.size() + near + far, frame.points_lidar.size());
}

TEST(Deskew, SensorPositionIsThatOfTheLidarOnTheBody) {
  DroppedPoints dropped;
  const Scan scan = placeOnBody(scanAlong(test::sway()), kNoLimits, dropped);
  EXPECT_LT((scan.sensor_position_body - kLidarPose.position).norm(), 1e-12);
}

TEST(Deskew, TellsHowOldEachPointIs) {
  DroppedPoints dropped;
  LidarFrame frame = scanAlong(test::sway());
  frame.points_lidar[1] = {0.1F, 0, 0};  // too near: left out of both lists
  const Scan scan = deskew(frame, ScanMotion(known(test::sway(), true, true)), {0.5, 100}, dropped);
  EXPECT_EQ(dropped.too_near, 1U);
  ASSERT_EQ(scan.ages_s.size(), scan.points_body.size());
  const double duration_s = seconds(frame.duration_ns);
  EXPECT_NEAR(scan.ages_s[0], duration_s - seconds(frame.dt_ns[0]), 1e-6);
  EXPECT_NEAR(scan.ages_s[1], duration_s - seconds(frame.dt_ns[2]), 1e-6);
  EXPECT_NEAR(scan.ages_s.back(), duration_s - seconds(frame.dt_ns.back()), 1e-6);
  EXPECT_TRUE(placeOnBody(frame, {0.5, 100}, dropped).ages_s.empty());
}

}  // namespace
}  // namespace paloc

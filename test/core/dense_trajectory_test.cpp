#include "paloc/core/dense_trajectory.h"

#include <gtest/gtest.h>

#include <random>

#include "paloc/core/mrpt_pose.h"
#include "smooth_motion.h"

namespace paloc {
namespace {

constexpr double kNode_s = 0.1;
constexpr double kMaxImuGap_s = 0.02;
constexpr double kMaxGap_s = 0.3;

std::vector<TrajectoryPoint> nodesOf(const test::SmoothMotion& motion, int count, double sigma_m) {
  std::mt19937_64 rng(4);
  std::normal_distribution<double> normal;
  std::vector<TrajectoryPoint> nodes;
  for (int k = 0; k < count; ++k) {
    const double t = 1 + k * kNode_s;
    Pose pose = motion.pose(t);
    pose.position += sigma_m * Vec3(normal(rng), normal(rng), normal(rng));
    TrajectoryPoint node;
    node.t_ns = nsFromSeconds(t);
    node.T_map_body = toMrpt(pose);
    node.v_map = motion.velocity(t);
    node.bias_acc = motion.bias_acc;
    node.bias_gyro = motion.bias_gyro;
    node.covariance = Mat6::Identity() * (k + 1);
    node.flag = PoseFlag::kGood;
    nodes.push_back(node);
  }
  return nodes;
}

ImuBuffer imuOf(const test::SmoothMotion& motion, double from, double to) {
  ImuBuffer buffer;
  for (double t = from; t <= to; t += 0.005) buffer.add(motion.imu(t));
  return buffer;
}

DenseTrajectory denseOf(std::vector<TrajectoryPoint> nodes, ImuBuffer imu,
                        const test::SmoothMotion& motion) {
  Result result;
  result.trajectory = std::move(nodes);
  EstimatorSettings settings;
  settings.gravity_mps2 = motion.gravity_mps2;
  settings.max_imu_gap_s = kMaxImuGap_s;
  settings.lost_sigma_position_m = 100;  // covariances here are of no account
  return {result, std::move(imu), settings, kMaxGap_s};
}

double errorAt(const DenseTrajectory& dense, const test::SmoothMotion& motion, double t) {
  const auto point = dense.at(nsFromSeconds(t));
  if (!point) return 1e9;
  const Vec6 error = boxminus(fromMrpt(point->T_map_body), motion.pose(t));
  return error.norm() + 0.1 * (point->v_map - motion.velocity(t)).norm();
}

TEST(DenseTrajectory, FollowsTheMotionBetweenNodes) {
  test::SmoothMotion motion;
  motion.bias_acc = Vec3(0.1, -0.2, 0.05);
  motion.bias_gyro = Vec3(0.01, 0.02, -0.01);
  const DenseTrajectory dense = denseOf(nodesOf(motion, 20, 0), imuOf(motion, 0.9, 3.1), motion);
  for (double t = 1.0; t < 2.89; t += 0.0137) EXPECT_LT(errorAt(dense, motion, t), 3e-4) << t;
}

TEST(DenseTrajectory, MeetsEveryNodeAndIsContinuousThere) {
  const test::SmoothMotion motion;
  const auto nodes = nodesOf(motion, 20, 0.01);  // nodes that the IMU does not agree with
  const DenseTrajectory dense = denseOf(nodes, imuOf(motion, 0.9, 3.1), motion);
  for (std::size_t k = 1; k + 1 < nodes.size(); ++k) {
    const Pose node = fromMrpt(nodes[k].T_map_body);
    EXPECT_EQ(fromMrpt(dense.at(nodes[k].t_ns)->T_map_body).position, node.position);
    for (const TimeNs step : {TimeNs{-1000}, TimeNs{1000}}) {  // a microsecond to either side
      const auto beside = dense.at(nodes[k].t_ns + step);
      ASSERT_TRUE(beside.has_value());
      EXPECT_LT((fromMrpt(beside->T_map_body).position - node.position).norm(), 5e-6);
      EXPECT_LT((beside->v_map - nodes[k].v_map).norm(), 1e-4);
      EXPECT_LT(so3::log(fromMrpt(beside->T_map_body).rotation.transpose() * node.rotation).norm(),
                5e-6);
    }
  }
}

TEST(DenseTrajectory, WithoutImuItIsACubicThroughPosesAndVelocities) {
  const test::SmoothMotion motion;
  const DenseTrajectory dense = denseOf(nodesOf(motion, 20, 0), ImuBuffer(), motion);
  for (double t = 1.0; t < 2.89; t += 0.0137) EXPECT_LT(errorAt(dense, motion, t), 5e-3) << t;
}

TEST(DenseTrajectory, AnswersOnlyWhereItKnows) {
  const test::SmoothMotion motion;
  auto nodes = nodesOf(motion, 20, 0);
  nodes.erase(nodes.begin() + 5, nodes.begin() + 12);
  nodes[3].flag = PoseFlag::kCoasting;
  const DenseTrajectory with_imu = denseOf(nodes, imuOf(motion, 0.9, 3.1), motion);
  const DenseTrajectory without = denseOf(nodes, ImuBuffer(), motion);
  EXPECT_FALSE(with_imu.at(nsFromSeconds(0.99)));
  EXPECT_FALSE(with_imu.at(nsFromSeconds(2.91)));
  EXPECT_TRUE(with_imu.at(nsFromSeconds(1.8))) << "the IMU bridges a hole of 0.8 s";
  EXPECT_FALSE(without.at(nsFromSeconds(1.8)));
  EXPECT_EQ(with_imu.at(nsFromSeconds(1.35))->flag, PoseFlag::kCoasting);
  EXPECT_EQ(with_imu.at(nsFromSeconds(1.05))->flag, PoseFlag::kGood);
  EXPECT_NEAR(with_imu.at(nsFromSeconds(1.05))->covariance(0, 0), 1.5, 1e-6);
}

TEST(DenseTrajectory, GrowsUnsureInAGapAndSaysSo) {
  const test::SmoothMotion motion;
  auto nodes = nodesOf(motion, 30, 0);
  for (TrajectoryPoint& node : nodes) node.covariance = 1e-8 * Mat6::Identity();
  nodes.erase(nodes.begin() + 5, nodes.begin() + 25);
  const DenseTrajectory dense = denseOf(nodes, imuOf(motion, 0.9, 4.1), motion);
  const auto sigmaAt = [&](double t) {
    return std::sqrt(dense.at(nsFromSeconds(t))->covariance(0, 0));
  };
  const double middle_s = 2.45;  // of the gap from 1.4 to 3.5
  EXPECT_GT(sigmaAt(middle_s), 2e-4);
  EXPECT_GT(sigmaAt(middle_s), sigmaAt(1.8));
  EXPECT_NEAR(sigmaAt(1.4), 1e-4, 1e-12) << "at a node it is the node's";
  EXPECT_NEAR(sigmaAt(1.4005), 1e-4, 1e-6) << "and beside it, too";
  EXPECT_EQ(dense.at(nsFromSeconds(1.5))->flag, PoseFlag::kGood);
  EXPECT_EQ(dense.at(nsFromSeconds(middle_s))->flag, PoseFlag::kCoasting);
}

TEST(DenseTrajectory, WithoutImuItAllowsForWhatThePlatformMayDo) {
  const test::SmoothMotion motion;
  auto nodes = nodesOf(motion, 20, 0);
  for (TrajectoryPoint& node : nodes) node.covariance = 1e-8 * Mat6::Identity();
  const DenseTrajectory dense = denseOf(nodes, ImuBuffer(), motion);
  for (double t = 1.013; t < 2.89; t += 0.1) {
    const auto point = dense.at(nsFromSeconds(t));
    const Vec6 error = boxminus(fromMrpt(point->T_map_body), motion.pose(t));
    for (int k = 0; k < 6; ++k) {
      EXPECT_LT(std::abs(error[k]), 3 * std::sqrt(point->covariance(k, k))) << t;
    }
  }
}

TEST(DenseTrajectory, ListsTheImuStampsItCovers) {
  const test::SmoothMotion motion;
  const DenseTrajectory dense = denseOf(nodesOf(motion, 3, 0), imuOf(motion, 0.9, 3.1), motion);
  const auto stamps = dense.imuStamps();
  EXPECT_NEAR(static_cast<double>(stamps.size()), 41, 1);
  for (const TimeNs t : stamps) EXPECT_TRUE(dense.at(t).has_value());
}

}  // namespace
}  // namespace paloc

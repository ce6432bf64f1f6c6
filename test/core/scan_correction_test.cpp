#include "paloc/core/scan_correction.h"

#include <gtest/gtest.h>

#include <cmath>

#include "paloc/core/pose.h"

namespace paloc {
namespace {

Vec3 toVec(const Point3f& p) {
  return {static_cast<double>(p.x), static_cast<double>(p.y), static_cast<double>(p.z)};
}

// Points seen from a body that turns and moves evenly, deskewed with a gyroscope that reads
// `bias` too much and a velocity that is off: put right, they lie where they were.
TEST(ScanCorrection, PutsPointsWhereTheTrueMotionHasThem) {
  const Vec3 omega(0.6, -0.3, 1.1), bias(0.012, -0.008, 0.005);
  const Vec3 v_body(0.9, -0.2, 0.1), v_assumed(0.95, -0.17, 0.08);
  Scan scan;
  std::vector<Vec3> truth;
  for (int i = 0; i < 40; ++i) {
    const double age = 0.0025 * i;
    const Vec3 place(8 * std::cos(0.4 * i), 8 * std::sin(0.4 * i), 0.1 * i - 2);  // at the end
    // The body's pose at the point's time, in its frame at the end: as it was, as it was taken.
    const Pose was{-age * v_body, so3::exp(-age * omega)};
    const Pose taken{-age * v_assumed, so3::exp(-age * (omega + bias))};
    const Vec3 put = taken * (was.inverse() * place);
    truth.push_back(place);
    scan.points_body.push_back(
        {static_cast<float>(put.x()), static_cast<float>(put.y()), static_cast<float>(put.z())});
    scan.ages_s.push_back(static_cast<float>(age));
  }
  scan.v_body_assumed = v_assumed;
  const Scan anew = deskewedAnew(scan, v_body, bias);
  EXPECT_EQ(anew.v_body_assumed, v_body);
  double before = 0, after = 0;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    before = std::max(before, (toVec(scan.points_body[i]) - truth[i]).norm());
    after = std::max(after, (toVec(anew.points_body[i]) - truth[i]).norm());
  }
  EXPECT_GT(before, 0.008);
  EXPECT_LT(after, 0.05 * before) << "half the turn of the scan, 0.06 rad, is left of the bias";
}

TEST(ScanCorrection, LeavesAScanWithoutTimesAsItIs) {
  Scan scan;
  scan.points_body.push_back({1, 2, 3});
  scan.v_body_assumed = Vec3::Zero();
  const Scan anew = deskewedAnew(scan, Vec3::Ones(), Vec3::Ones());
  EXPECT_EQ(toVec(anew.points_body[0]), Vec3(1, 2, 3));
}

TEST(ScanCorrection, WeighsTheVelocitiesByWhatIsKnownOfThem) {
  auto scan = std::make_shared<Scan>();
  scan->points_body.push_back({0, 0, 0});
  scan->ages_s.push_back(0.1F);
  scan->v_body_assumed = Vec3(1.3, 0, 0);
  OdometryFrame frame;
  frame.t_ns = nsFromSeconds(0.1);
  frame.scan = scan;
  State predicted;
  predicted.v_map = Vec3(1, 0, 0);
  NodeEstimate last;
  const auto velocity = [&](double sigma_imu, double sigma_step_m) {
    last.covariance.block<3, 3>(tangent::kVelocity, tangent::kVelocity) =
        sigma_imu * sigma_imu * Mat3::Identity();
    frame.motion_covariance = sigma_step_m * sigma_step_m * Mat6::Identity();
    return withScanDeskewedAnew(frame, last, predicted).scan->v_body_assumed->x();
  };
  EXPECT_DOUBLE_EQ(velocity(0.02, 0.002), 1) << "an odometry that does not go on tells nothing";
  frame.continues = true;
  EXPECT_DOUBLE_EQ(velocity(0.02, 0.002), 1.15) << "2 mm in 0.1 s are 20 mm/s";
  EXPECT_DOUBLE_EQ(velocity(0, 0.002), 1);
  EXPECT_NEAR(velocity(0.02, 1), 1, 1e-3);
}

}  // namespace
}  // namespace paloc

#include "paloc/core/scan_skew.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "paloc/core/so3.h"

namespace paloc {
namespace {

constexpr TimeNs kMs = 1'000'000;
constexpr double kScan_s = 0.1, kFrame_s = 0.2;  // every other scan is missing

Vec3 toVec(const Point3f& p) {
  return {static_cast<double>(p.x), static_cast<double>(p.y), static_cast<double>(p.z)};
}

// Where things are about the body at the scan's end.
Vec3 placeOf(int i) { return {8 * std::cos(0.4 * i), 8 * std::sin(0.4 * i), 0.1 * i - 2}; }

constexpr int kPoints = 101;
double ageOf(int i) { return kScan_s * i / (kPoints - 1); }

/// Points whose ages are spread evenly over the scan, each put where a motion error of `e` a frame
/// puts it.
Scan scanWith(ScanSkew skew, const Vec3& e) {
  Scan scan;
  scan.end_ns = 1'000'000 * kMs;
  scan.start_ns = scan.end_ns - 100 * kMs;
  scan.skew = skew;
  for (int i = 0; i < kPoints; ++i) {
    const Vec3 put = placeOf(i) + ageOf(i) / kFrame_s * e;
    scan.points_body.push_back(
        {static_cast<float>(put.x()), static_cast<float>(put.y()), static_cast<float>(put.z())});
  }
  return scan;
}

Vec3 meanOffset(const Scan& scan) {
  Vec3 sum = Vec3::Zero();
  for (int i = 0; i < kPoints; ++i) {
    sum += toVec(scan.points_body[static_cast<std::size_t>(i)]) - placeOf(i);
  }
  return sum / kPoints;
}

TEST(ScanSkew, AScanWithoutIsLeftAlone) {
  const Scan scan = scanWith(ScanSkew::kNone, Vec3(0.1, 0, 0));
  const Scan told =
      withSkewTold(scan, Pose{Vec3(0.2, 0, 0), Mat3::Identity()}, Mat6::Identity(), kFrame_s);
  EXPECT_TRUE(told.skew_covariance.isZero());
  EXPECT_EQ(meanOffset(told), meanOffset(scan));
}

// A motion that is off by e along one axis, one sigma, puts the points off by their mean offset:
// that is one sigma of the covariance told, in the frame at the end.
TEST(ScanSkew, TheOdometrysErrorMovesTheScanByItsMeanAge) {
  const Pose motion{Vec3(0.2, 0.05, 0), so3::exp(Vec3(0, 0, 0.3))};
  const Vec3 sigma(0.03, 0.01, 0.02);  // in the frame of the beginning
  Mat6 covariance = Mat6::Zero();
  covariance.diagonal().head<3>() = sigma.array().square();
  covariance.diagonal().tail<3>().setConstant(0.01 * 0.01);
  Mat3 expected = Mat3::Zero();
  for (int axis = 0; axis < 3; ++axis) {
    const Vec3 e = motion.rotation.transpose() * (sigma[axis] * Vec3::Unit(axis));
    const Vec3 off = meanOffset(scanWith(ScanSkew::kOfOdometry, e));
    expected += off * off.transpose();
  }
  const Scan scan = scanWith(ScanSkew::kOfOdometry, Vec3::Zero());
  const Scan told = withSkewTold(scan, motion, covariance, kFrame_s);
  EXPECT_LT((told.skew_covariance.topLeftCorner<3, 3>() - expected).norm(), 1e-8);
  EXPECT_NEAR(std::sqrt(told.skew_covariance(4, 4)), 0.01 * kScan_s / kFrame_s / 2, 1e-9);
  EXPECT_EQ(meanOffset(told), meanOffset(scan)) << "nobody knows which way";
}

// Points as the LiDAR saw them while the body went on and turned.
TEST(ScanSkew, AScanThatWasNotDeskewedIsMovedByHalfItsMotion) {
  const Vec3 v_body(1.2, -0.3, 0.1), omega(0, 0, 0.5);
  Scan scan = scanWith(ScanSkew::kWhole, Vec3::Zero());
  for (int i = 0; i < kPoints; ++i) {
    const Pose was{-ageOf(i) * v_body, so3::exp(-ageOf(i) * omega)};
    const Vec3 seen = was.inverse() * placeOf(i);
    scan.points_body[static_cast<std::size_t>(i)] = {
        static_cast<float>(seen.x()), static_cast<float>(seen.y()), static_cast<float>(seen.z())};
  }
  EXPECT_GT(meanOffset(scan).norm(), 0.05);
  const Pose motion{kFrame_s * v_body, so3::exp(kFrame_s * omega)};
  const Scan told = withSkewTold(scan, motion, Mat6::Zero(), kFrame_s);
  EXPECT_LT(meanOffset(told).norm(), 0.01);
  EXPECT_GT((told.sensor_position_body - scan.sensor_position_body).norm(), 0.05);
  // Seen at the scan's start or end alone, it would be off by twice the sigma told.
  const Vec3 along = (motion.rotation.transpose() * v_body).normalized();
  const double sigma = std::sqrt(along.dot(told.skew_covariance.topLeftCorner<3, 3>() * along));
  EXPECT_NEAR(sigma, v_body.norm() * kScan_s / 4, 1e-6);
  EXPECT_NEAR(std::sqrt(told.skew_covariance(5, 5)), omega.norm() * kScan_s / 4, 1e-6);
}

}  // namespace
}  // namespace paloc

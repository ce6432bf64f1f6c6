#include "paloc/map/scan_matcher.h"

#include <gtest/gtest.h>

#include <cstring>

#include "paloc/core/mrpt_pose.h"
#include "simulated_rooms.h"

namespace paloc {
namespace {

using test::furnishedRoom;
using test::sampleMap;
using test::simulateScan;

const Pose kBodyInWorld{Vec3(-0.5, -0.3, 1.4), so3::exp(Vec3(0.02, 0.01, 0.5))};

Pose truthIn(const test::BoxWorld& world) { return world.T_map_world * kBodyInWorld; }

std::shared_ptr<const PriorMap> roomMap() {
  static const auto map = PriorMap::build(sampleMap(furnishedRoom(), 0.06, 0.003, 1), {});
  return map;
}

Scan roomScan(unsigned seed = 5) {
  const test::BoxWorld world = furnishedRoom();
  return simulateScan(world, truthIn(world), 20000, {0.02}, 30, seed);
}

mrpt::poses::CPose3D moved(const Pose& pose, double x, double y, double z, double roll,
                           double pitch, double yaw) {
  Vec6 delta;
  delta << x, y, z, roll, pitch, yaw;
  return toMrpt(boxplus(pose, delta));
}

TEST(ScanMatcher, FindsThePoseFromAPrediction) {
  const Pose truth = truthIn(furnishedRoom());
  const auto matcher = ScanMatcher::onto(roomMap(), {});
  for (unsigned seed = 0; seed < 5; ++seed) {
    const double s = seed % 2 == 0 ? 1 : -1;
    const MapMatch match = matcher->match(
        roomScan(seed), moved(truth, s * 0.1, 0.08, -s * 0.06, 0.01, s * 0.01, -0.01), 0.05, 0.01);
    ASSERT_TRUE(match.accepted()) << toString(match.refusal);
    const Vec6 error = boxminus(fromMrpt(match.T_map_body), truth);
    EXPECT_LT(error.head<3>().norm(), 0.006);
    EXPECT_LT(error.tail<3>().norm(), 0.002);
    EXPECT_GT(match.overlap, 0.8);
    EXPECT_LT(match.residual_rms_m, 0.03);
    EXPECT_TRUE(match.information.allFinite());
    EXPECT_LT(error.dot(match.information * error) / 6, 3);
  }
}

// What a scan says of the motion left in it comes on top of the pose's covariance, and stays with
// the points that are kept for another match.
TEST(ScanMatcher, TheSkewOfAScanIsInItsCovariance) {
  const Pose truth = truthIn(furnishedRoom());
  const auto matcher = ScanMatcher::onto(roomMap(), {});
  Scan scan = roomScan();
  const auto covarianceOf = [&](const Scan& tried) {
    const MapMatch match = matcher->match(tried, toMrpt(truth), 0.05, 0.01);
    EXPECT_TRUE(match.accepted());
    return Mat6(Eigen::Matrix<double, 6, 6>(match.informationAmong(1)).inverse());
  };
  const Mat6 without = covarianceOf(scan);
  scan.skew_covariance.diagonal() << 4e-4, 1e-4, 1e-6, 1e-6, 1e-6, 4e-6;
  const MapMatch match = matcher->match(scan, toMrpt(truth), 0.05, 0.01);
  const Mat3 R = fromMrpt(match.T_map_body).rotation;
  Mat6 expected = scan.skew_covariance;
  expected.topLeftCorner<3, 3>() = R * scan.skew_covariance.topLeftCorner<3, 3>() * R.transpose();
  EXPECT_LT((covarianceOf(scan) - without - expected).norm(), 0.02 * expected.norm());
  ASSERT_TRUE(match.thinned);
  EXPECT_EQ(match.thinned->skew_covariance, scan.skew_covariance);
}

TEST(ScanMatcher, LocatesFromARoughPose) {
  const Pose truth = truthIn(furnishedRoom());
  const auto matcher = ScanMatcher::onto(roomMap(), {});
  const std::vector<mrpt::poses::CPose3D> starts{
      moved(truth, 0.5, 0, 0, 0, 0, 0.087), moved(truth, -0.3, 0.4, 0.1, 0.02, 0, -0.087),
      moved(truth, 0.6, -0.6, 0, 0, 0, 0.17), moved(truth, -0.7, -0.5, -0.1, 0, 0.02, -0.17)};
  for (const auto& start : starts) {
    StartGuess guess;
    guess.T_map_body = start;
    const MapMatch match = matcher->locate(roomScan(), guess);
    ASSERT_TRUE(match.accepted()) << toString(match.refusal);
    EXPECT_LT(boxminus(fromMrpt(match.T_map_body), truth).norm(), 0.01);
  }
}

TEST(ScanMatcher, SameBytesOnOneThreadAndTwo) {
  const Pose truth = truthIn(furnishedRoom());
  MatcherSettings settings;
  settings.threads = 1;
  const MapMatch one = ScanMatcher::onto(roomMap(), settings)
                           ->match(roomScan(), moved(truth, 0.1, 0, 0, 0, 0, 0.01), 0.05, 0.01);
  settings.threads = 2;
  const MapMatch two = ScanMatcher::onto(roomMap(), settings)
                           ->match(roomScan(), moved(truth, 0.1, 0, 0, 0, 0, 0.01), 0.05, 0.01);
  const Pose a = fromMrpt(one.T_map_body), b = fromMrpt(two.T_map_body);
  EXPECT_EQ(std::memcmp(a.position.data(), b.position.data(), sizeof(Vec3)), 0);
  EXPECT_EQ(std::memcmp(a.rotation.data(), b.rotation.data(), sizeof(Mat3)), 0);
  EXPECT_EQ(std::memcmp(one.information.data(), two.information.data(), sizeof(Mat6)), 0);
}

TEST(ScanMatcher, RefusalsSayWhy) {
  const Pose truth = truthIn(furnishedRoom());
  const auto guess = toMrpt(truth);
  const auto refusalOf = [&](const MatcherSettings& settings, const Scan& scan,
                             const mrpt::poses::CPose3D& start) {
    const MapMatch match = ScanMatcher::onto(roomMap(), settings)->match(scan, start, 0.02, 0.005);
    EXPECT_TRUE(match.information.allFinite());
    return match.refusal;
  };
  const Scan scan = roomScan();
  EXPECT_EQ(refusalOf({}, scan, guess), MatchRefusal::kNone);
  EXPECT_EQ(refusalOf({}, {}, guess), MatchRefusal::kNoScan);
  Scan few = scan;
  few.points_body.resize(20);
  EXPECT_EQ(refusalOf({}, few, guess), MatchRefusal::kTooFewPoints);
  EXPECT_EQ(refusalOf({}, scan, moved(truth, 200, 0, 0, 0, 0, 0)), MatchRefusal::kOutsideMap);
  MatcherSettings strict;
  strict.min_inliers = 3990;
  strict.max_points = 4000;
  EXPECT_EQ(refusalOf(strict, scan, guess), MatchRefusal::kTooFewInliers);
  strict = {};
  strict.min_overlap = 0.999;
  EXPECT_EQ(refusalOf(strict, scan, guess), MatchRefusal::kLowOverlap);
  strict = {};
  strict.max_residual_rms_m = 0.005;
  EXPECT_EQ(refusalOf(strict, scan, guess), MatchRefusal::kHighResidual);
  strict = {};
  strict.step_floor_m = 0;
  strict.step_floor_rad = 0;
  EXPECT_EQ(refusalOf(strict, scan, moved(truth, 0.15, 0, 0, 0, 0, 0)), MatchRefusal::kLargeStep);
  strict = {};
  strict.max_iterations = 2;
  EXPECT_EQ(refusalOf(strict, scan, moved(truth, 0.1, 0, 0, 0, 0, 0)), MatchRefusal::kNotConverged);
}

TEST(ScanMatcher, AWrongPlaceIsNotBelieved) {
  // A scan of another room, of other size and furniture, in this map.
  test::BoxWorld other{
      {{Vec3(-2, -6, 0), Vec3(2.5, 7, 4)}, {Vec3(0.5, 2, 0), Vec3(2.5, 3, 2.5)}}, {}, {}};
  const Scan scan = simulateScan(other, {Vec3(0, 0, 1.4), Mat3::Identity()}, 20000, {0.02}, 30, 3);
  StartGuess guess;
  guess.T_map_body = toMrpt(truthIn(furnishedRoom()));
  const MapMatch match = ScanMatcher::onto(roomMap(), {})->locate(scan, guess);
  EXPECT_FALSE(match.accepted());
}

}  // namespace
}  // namespace paloc

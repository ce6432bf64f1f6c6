#include <gtest/gtest.h>

#include <limits>
#include <random>

#include "paloc/core/mrpt_pose.h"
#include "paloc/core/trajectory_generator.h"
#include "smooth_motion.h"

namespace paloc {
namespace {

constexpr double kFrame_s = 0.1, kDarkFrom_s = 8, kDark_s = 10, kEnd_s = 30;
constexpr double kSigma_m = 0.01, kSigma_rad = 0.002;

/// A map whose every place looks like every other to registration, while a search tells the truth.
class DeceptiveMap : public MapMatcher {
 public:
  explicit DeceptiveMap(const test::SmoothMotion& motion) : motion_(motion) {}

  MapMatch match(const Scan& scan, const mrpt::poses::CPose3D& guess, double, double) override {
    const Pose truth = motion_.pose(secondsBetween(0, scan.end_ns));
    const bool near = (fromMrpt(guess).position - truth.position).norm() < 1;
    return at(near ? truth : fromMrpt(guess));
  }
  MapMatch locate(const Scan& scan, const StartGuess&) override {
    MapMatch match = at(motion_.pose(secondsBetween(0, scan.end_ns)));
    if (!knows_all) match.refusal = MatchRefusal::kNoPlaceFound;
    const double t = secondsBetween(0, scan.end_ns);
    if (t > broken_from_s && t < broken_to_s) {
      match.T_map_body.x(std::numeric_limits<double>::quiet_NaN());
    }
    return match;
  }

  bool knows_all = true;
  double broken_from_s = 0, broken_to_s = 0;  // when what a search finds is no pose

 private:
  MapMatch at(const Pose& pose) {
    Vec6 noise;
    for (int i = 0; i < 6; ++i) noise[i] = (i < 3 ? kSigma_m : kSigma_rad) * normal_(rng_);
    MapMatch match;
    match.refusal = MatchRefusal::kNone;
    match.T_map_body = toMrpt(boxplus(pose, noise));
    match.information.diagonal() << Vec3::Constant(1 / (kSigma_m * kSigma_m)),
        Vec3::Constant(1 / (kSigma_rad * kSigma_rad));
    for (std::size_t i = 0; i < 6; ++i) {
      match.directions[i] = {
          Vec3::Unit(static_cast<int>(i % 3)), DirectionClass::kFull, 1, 1, 1, 0};
    }
    match.thinned = std::make_shared<const Scan>();
    return match;
  }

  const test::SmoothMotion& motion_;
  std::mt19937_64 rng_{7};
  std::normal_distribution<double> normal_;
};

/// Ten seconds of a walk were not recorded at all, from `dark_from_s`; for `broken_s` then, the map
/// answers with poses that are none.
Result runThroughTheDark(bool map_knows_all, double dark_from_s = kDarkFrom_s,
                         double broken_s = 0) {
  const double dark_to_s = dark_from_s + kDark_s;
  test::SmoothMotion motion;
  const auto map = std::make_shared<DeceptiveMap>(motion);
  map->broken_from_s = dark_to_s;
  map->broken_to_s = dark_to_s + broken_s;
  TrajectoryGenerator generator(EstimatorSettings(), map);
  generator.setInitialPose(toMrpt(motion.pose(kFrame_s)));
  const auto recorded = [=](double t) { return t < dark_from_s || t > dark_to_s; };
  bool first = true;
  for (int f = 1; f * kFrame_s < kEnd_s; ++f) {
    for (int k = 0; k <= 20; ++k) {
      const double t = (f - 1 + k / 20.0) * kFrame_s;
      if (recorded(t) && (k < 20 || recorded(t + kFrame_s))) generator.add(motion.imu(t));
    }
    const double t = f * kFrame_s;
    if (!recorded(t)) {
      first = true;
      map->knows_all = map_knows_all;
      continue;
    }
    generator.add(motion.imu(t + 0.005));
    OdometryFrame frame;
    frame.t_ns = nsFromSeconds(t);
    frame.T_odom_body = toMrpt(motion.pose(t));
    frame.continues = !first;
    frame.motion_covariance.diagonal() << Vec3::Constant(1e-6), Vec3::Constant(1e-7);
    auto scan = std::make_shared<Scan>();
    scan->end_ns = frame.t_ns;
    frame.scan = scan;
    generator.add(frame);
    first = false;
  }
  return generator.finish();
}

double errorAt(const TrajectoryPoint& point) {
  static const test::SmoothMotion motion;
  return (fromMrpt(point.T_map_body).position - motion.pose(secondsBetween(0, point.t_ns)).position)
      .norm();
}

TEST(Kidnapped, IsFoundAndTheNodesSinceComeAlong) {
  const Result result = runThroughTheDark(true);
  ASSERT_GT(result.trajectory.size(), 150u);
  for (const TrajectoryPoint& p : result.trajectory) {
    EXPECT_LT(errorAt(p), 5 * kSigma_m) << secondsBetween(0, p.t_ns) << " s";
  }
  EXPECT_EQ(result.repairs.reanchored, 1u);
  // Online, what was not known yet is flagged.
  for (const TrajectoryPoint& p : result.online) {
    if (errorAt(p) > 5 * kSigma_m) {
      EXPECT_EQ(p.flag, PoseFlag::kLost) << secondsBetween(0, p.t_ns) << " s";
    }
  }
  std::size_t not_confirmed = 0;
  for (const FrameDiagnostics& row : result.diagnostics) {
    not_confirmed += row.match.refusal == MatchRefusal::kNotConfirmed ? 1 : 0;
  }
  EXPECT_GE(not_confirmed, 5u);
}

TEST(Kidnapped, WhoIsNotFoundIsFlaggedAsLost) {
  const Result result = runThroughTheDark(false);
  std::size_t lost = 0;
  for (const TrajectoryPoint& p : result.trajectory) {
    if (p.t_ns < nsFromSeconds(kDarkFrom_s + kDark_s)) {
      EXPECT_LT(errorAt(p), 5 * kSigma_m);
    } else {
      EXPECT_EQ(p.flag, PoseFlag::kLost) << errorAt(p);
      ++lost;
    }
  }
  EXPECT_GT(lost, 100u);
}

// So soon after the start nothing is known of what is usual, and such a pose comes through to the
// smoother, which refuses it: the window before must be there still.
TEST(Kidnapped, APlaceThatIsNoPoseBeginsNoWindow) {
  const Result result = runThroughTheDark(true, 1.5, 3);
  ASSERT_GT(result.trajectory.size(), 100u);
  for (const TrajectoryPoint& p : result.trajectory) {
    EXPECT_LT(errorAt(p), 5 * kSigma_m) << secondsBetween(0, p.t_ns) << " s";
  }
  EXPECT_EQ(result.repairs.reanchored, 1u);
}

}  // namespace
}  // namespace paloc

#include "paloc/core/trajectory_generator.h"

#include <gtest/gtest.h>

#include <functional>
#include <limits>
#include <random>
#include <set>

#include "paloc/core/mrpt_pose.h"
#include "smooth_motion.h"

namespace paloc {
namespace {

constexpr double kFrame_s = 0.1;
constexpr double kMapSigma_m = 0.02;
constexpr double kMapSigma_rad = 0.004;

/// A map that knows the truth, up to noise, except when `available` says that it does not.
class TruthMatcher : public MapMatcher {
 public:
  explicit TruthMatcher(const test::SmoothMotion& motion) : motion_(motion) {}

  MapMatch match(const Scan& scan, const mrpt::poses::CPose3D& guess, double sigma_position,
                 double) override {
    MapMatch m = answer(scan);
    const Vec6 step = boxminus(fromMrpt(m.T_map_body), fromMrpt(guess));
    if (m.accepted() && step.head<3>().norm() > 5 * sigma_position + 0.2) {
      m.refusal = MatchRefusal::kLargeStep;
    }
    return m;
  }
  MapMatch locate(const Scan& scan, const StartGuess&) override { return answer(scan); }

  std::function<bool(double)> available = [](double) { return true; };
  bool degenerate = false;

 private:
  MapMatch answer(const Scan& scan) {
    const double t = secondsBetween(0, scan.end_ns);
    Vec6 noise;
    noise << kMapSigma_m * normal3(), kMapSigma_rad * normal3();
    MapMatch m;
    m.refusal = available(t) ? MatchRefusal::kNone : MatchRefusal::kLowOverlap;
    m.T_map_body = toMrpt(boxplus(motion_.pose(t), noise));
    m.information.diagonal() << Vec3::Constant(1 / (kMapSigma_m * kMapSigma_m)),
        Vec3::Constant(1 / (kMapSigma_rad * kMapSigma_rad));
    for (std::size_t i = 0; i < 6; ++i) {
      m.directions[i].axis_body = Vec3::Unit(static_cast<int>(i % 3));
      m.directions[i].cls = DirectionClass::kFull;
      m.directions[i].share = 1;
    }
    if (degenerate) m.directions[0].cls = DirectionClass::kNone;
    return m;
  }
  Vec3 normal3() { return {normal_(rng_), normal_(rng_), normal_(rng_)}; }

  const test::SmoothMotion& motion_;
  std::mt19937_64 rng_{7};
  std::normal_distribution<double> normal_;
};

struct Simulation {
  test::SmoothMotion motion;
  std::shared_ptr<TruthMatcher> matcher = std::make_shared<TruthMatcher>(motion);
  EstimatorSettings settings;
  bool with_imu = true, with_odometry = true, with_initial_pose = true;
  double duration_s = 20;
  double odometry_scale = 1;      // of its positions
  bool inertial_along_x = false;  // of the map: there only the IMU tells the odometry's motion

  Simulation() {
    motion.bias_acc = Vec3(0.03, -0.02, 0.05);
    motion.bias_gyro = Vec3(0.001, 0.002, -0.001);
  }

  Result run() {
    TrajectoryGenerator generator(settings, matcher);
    if (with_initial_pose) generator.setInitialPose(toMrpt(motion.pose(kFrame_s)));
    const int steps_per_frame = 20;
    const double step = kFrame_s / steps_per_frame;
    const int frames = static_cast<int>(duration_s / kFrame_s);
    for (int f = 0; f <= frames; ++f) {
      for (int k = 0; k < steps_per_frame && with_imu; ++k) {
        generator.add(motion.imu(f * kFrame_s + k * step));
      }
      if (f == 0) continue;
      if (with_imu) generator.add(motion.imu((f + 1) * kFrame_s));
      generator.add(frameAt(f));
    }
    return generator.finish();
  }

  OdometryFrame frameAt(int f) const {
    OdometryFrame frame;
    frame.t_ns = nsFromSeconds(f * kFrame_s);
    frame.T_odom_body = toMrpt(motion.pose(kFrame_s).inverse() * motion.pose(f * kFrame_s));
    frame.T_odom_body.x(odometry_scale * frame.T_odom_body.x());
    frame.T_odom_body.y(odometry_scale * frame.T_odom_body.y());
    frame.T_odom_body.z(odometry_scale * frame.T_odom_body.z());
    frame.continues = with_odometry && f > 1;
    frame.motion_covariance.diagonal() << Vec3::Constant(1e-4), Vec3::Constant(1e-5);
    if (inertial_along_x) {
      Vec6 along_x = Vec6::Zero();
      along_x.head<3>() = motion.pose((f - 1) * kFrame_s).rotation.transpose() * Vec3::UnitX();
      frame.open_motion = along_x * along_x.transpose();
    }
    auto scan = std::make_shared<Scan>();
    scan->end_ns = frame.t_ns;
    frame.scan = scan;
    return frame;
  }

  double rmse(const std::vector<TrajectoryPoint>& points) const {
    double sum = 0;
    for (const TrajectoryPoint& p : points) {
      const Pose truth = motion.pose(secondsBetween(0, p.t_ns));
      sum += (fromMrpt(p.T_map_body).position - truth.position).squaredNorm();
    }
    return std::sqrt(sum / static_cast<double>(points.size()));
  }
};

TEST(TrajectoryGenerator, SmoothsFarBelowTheMapsNoise) {
  Simulation simulation;
  const Result result = simulation.run();
  ASSERT_EQ(result.trajectory.size(), 200u);
  ASSERT_EQ(result.online.size(), 200u);
  EXPECT_LT(simulation.rmse(result.trajectory), 0.3 * kMapSigma_m);
  EXPECT_LT(simulation.rmse(result.online), 0.5 * kMapSigma_m);
  EXPECT_EQ(result.repairs.total(), 0u);
  for (const TrajectoryPoint& p : result.trajectory) EXPECT_EQ(p.flag, PoseFlag::kGood);
  const TrajectoryPoint& last = result.trajectory.back();
  EXPECT_LT((last.bias_acc - simulation.motion.bias_acc).norm(), 5 * last.bias_acc_sigma.norm());
  EXPECT_LT((last.bias_gyro - simulation.motion.bias_gyro).norm(), 5 * last.bias_gyro_sigma.norm());
}

TEST(TrajectoryGenerator, CoastsThroughAHoleInTheMapAndSaysSo) {
  Simulation simulation;
  simulation.matcher->available = [](double t) { return t < 8 || t > 11; };
  const Result result = simulation.run();
  ASSERT_EQ(result.trajectory.size(), 200u);
  EXPECT_LT(simulation.rmse(result.trajectory), kMapSigma_m);
  double sigma_before = 0, sigma_inside = 0;
  for (const TrajectoryPoint& p : result.trajectory) {
    const double t = secondsBetween(0, p.t_ns);
    EXPECT_EQ(p.flag, t > 8.4 && t < 10.6   ? PoseFlag::kCoasting
                      : t > 7.9 && t < 11.1 ? p.flag
                                            : PoseFlag::kGood)
        << t;
    if (std::abs(t - 7) < 0.05) sigma_before = std::sqrt(p.covariance(0, 0));
    if (std::abs(t - 9.5) < 0.05) sigma_inside = std::sqrt(p.covariance(0, 0));
  }
  EXPECT_GT(sigma_inside, 1.2 * sigma_before);
}

TEST(TrajectoryGenerator, WorksWithoutImuOrWithoutOdometry) {
  Simulation without_imu;
  without_imu.with_imu = false;
  const Result a = without_imu.run();
  ASSERT_EQ(a.trajectory.size(), 200u);
  EXPECT_LT(without_imu.rmse(a.trajectory), kMapSigma_m);
  Simulation without_odometry;
  without_odometry.with_odometry = false;
  const Result b = without_odometry.run();
  ASSERT_EQ(b.trajectory.size(), 200u);
  EXPECT_LT(without_odometry.rmse(b.trajectory), 0.5 * kMapSigma_m);
}

// A LiDAR-inertial odometry in a tunnel: along it, it says what the IMU says, and its velocity is
// wrong by the same for long.
TEST(TrajectoryGenerator, TakesNothingFromMotionsThatOnlyTheImuTold) {
  Simulation simulation;
  simulation.matcher->available = [](double t) { return t < 6 || t > 10; };
  simulation.odometry_scale = 0.8;
  const auto errorAndSigma = [&](bool told) {
    simulation.inertial_along_x = told;
    double error = 0, ratio = 0;
    for (const TrajectoryPoint& p : simulation.run().trajectory) {
      const double off =
          p.T_map_body.x() - simulation.motion.pose(secondsBetween(0, p.t_ns)).position.x();
      error = std::max(error, std::abs(off));
      ratio = std::max(ratio, std::abs(off) / std::sqrt(p.covariance(0, 0)));
    }
    return std::pair(error, ratio);
  };
  const auto [error, ratio] = errorAndSigma(true);
  EXPECT_LT(error, 0.03);
  EXPECT_LT(ratio, 4);
  EXPECT_GT(errorAndSigma(false).first, 2 * error) << "else this test tests nothing";
}

TEST(TrajectoryGenerator, FlagsDegenerateDirections) {
  Simulation simulation;
  simulation.matcher->degenerate = true;
  simulation.duration_s = 3;
  for (const TrajectoryPoint& p : simulation.run().trajectory)
    EXPECT_EQ(p.flag, PoseFlag::kDegenerate);
}

TEST(TrajectoryGenerator, SaysWhyThereIsNoTrajectory) {
  Simulation simulation;
  simulation.duration_s = 3;
  simulation.with_initial_pose = false;
  Result result = simulation.run();
  EXPECT_TRUE(result.trajectory.empty());
  EXPECT_NE(result.no_trajectory_reason.find("--init-pose"), std::string::npos);
  simulation.with_initial_pose = true;
  simulation.matcher->available = [](double) { return false; };
  result = simulation.run();
  EXPECT_TRUE(result.trajectory.empty());
  EXPECT_NE(result.no_trajectory_reason.find("low overlap"), std::string::npos);
}

TEST(TrajectoryGenerator, OdometryGoesOnAcrossAFrameThatCannotBeUsed) {
  Simulation simulation;
  simulation.with_imu = false;
  TrajectoryGenerator generator(simulation.settings, simulation.matcher);
  generator.setInitialPose(toMrpt(simulation.motion.pose(kFrame_s)));
  // Only the first scan finds the map: all else hangs on the odometry.
  simulation.matcher->available = [](double t) { return t < 0.15; };
  for (int f = 1; f <= 100; ++f) {
    OdometryFrame frame = simulation.frameAt(f);
    if (f % 10 == 5) frame.T_odom_body.x(std::numeric_limits<double>::quiet_NaN());
    generator.add(frame);
  }
  EXPECT_EQ(generator.unused().total(), 10u);
  const Result result = generator.finish();
  ASSERT_EQ(result.trajectory.size(), 90u);
  for (const FrameDiagnostics& row : result.diagnostics) {
    EXPECT_TRUE(row.has_odometry_factor || &row == &result.diagnostics.front());
  }
  // Without the way that the lost frames cover, each of them would cost some ten centimetres.
  EXPECT_LT(simulation.rmse(result.trajectory), 2 * kMapSigma_m);
}

/// Refuses scans from 5 s to 9 s when it first sees them; then it knows them from near the truth.
class LateMatcher : public TruthMatcher {
 public:
  explicit LateMatcher(const test::SmoothMotion& motion) : TruthMatcher(motion), motion_(motion) {}
  MapMatch match(const Scan& scan, const mrpt::poses::CPose3D& guess, double sigma_position,
                 double sigma_rotation) override {
    MapMatch m = TruthMatcher::match(scan, guess, sigma_position, sigma_rotation);
    m.thinned = std::make_shared<const Scan>(scan);
    const double t = secondsBetween(0, scan.end_ns);
    const Vec6 off = boxminus(fromMrpt(guess), motion_.pose(t));
    const bool first_time = seen_.insert(scan.end_ns).second;
    if (t > 5 && t < 9 && (first_time || off.head<3>().norm() > 0.5)) {
      m.refusal = MatchRefusal::kLowOverlap;
    }
    return m;
  }
  MapMatch locate(const Scan& scan, const StartGuess& guess) override {
    return match(scan, *guess.T_map_body, 1, 1);
  }

 private:
  std::set<TimeNs> seen_;
  const test::SmoothMotion& motion_;
};

TEST(TrajectoryGenerator, AssociatesAnewWhereSmoothingMovedThePoses) {
  Simulation simulation;
  simulation.with_imu = false;
  simulation.duration_s = 14;
  simulation.odometry_scale = 1.3;
  simulation.settings.rematch_position_m = 0.01;
  const auto runAnew = [&] {
    simulation.matcher = std::make_shared<LateMatcher>(simulation.motion);
    return simulation.run();
  };
  const Result result = runAnew();
  std::size_t refused = 0;
  for (const FrameDiagnostics& row : result.diagnostics) refused += row.match.accepted() ? 0 : 1;
  EXPECT_GT(refused, 20u);
  EXPECT_GT(result.rematched.gained, refused / 2);
  EXPECT_EQ(result.rematched.withdrawn, 0u);
  EXPECT_EQ(result.rematched.not_kept, 0u);
  EXPECT_EQ(result.repairs.total(), 0u);

  simulation.settings.max_rematch_rounds = 0;
  const Result once = runAnew();
  EXPECT_EQ(once.rematched.tried, 0u);
  EXPECT_LT(simulation.rmse(result.trajectory), 0.7 * simulation.rmse(once.trajectory));

  simulation.settings.max_rematch_rounds = 3;
  simulation.settings.rematch_memory_mb = 0;
  const Result no_memory = runAnew();
  EXPECT_EQ(no_memory.rematched.gained, result.rematched.gained) << "refused scans are kept";
}

/// Finds scans by search; before `right_from_s` at a place 3 m beside the truth.
class SearchMatcher : public TruthMatcher {
 public:
  using TruthMatcher::TruthMatcher;
  double right_from_s = 0;
  int searches = 0, asked = 0;
  int denied_at = -10;  // and at the time after, scans would be no start themselves

  MapMatch locate(const Scan& scan, const StartGuess& guess) override {
    MapMatch m = TruthMatcher::locate(scan, guess);
    if (guess.T_map_body) {  // asked whether the scan bears out a start
      if (++asked == denied_at || asked == denied_at + 1) m.refusal = MatchRefusal::kNotVerified;
      return m;
    }
    ++searches;
    EXPECT_TRUE(guess.up_body);
    m.searched = true;
    if (secondsBetween(0, scan.end_ns) < right_from_s) m.T_map_body.x_incr(3);
    return m;
  }
};

struct SearchedRun {
  Simulation simulation;
  std::shared_ptr<SearchMatcher> matcher = std::make_shared<SearchMatcher>(simulation.motion);

  Result run() {
    simulation.matcher = matcher;
    TrajectoryGenerator generator(simulation.settings, matcher);
    generator.setInitialGuess({});
    for (int f = 0; f <= static_cast<int>(simulation.duration_s / kFrame_s); ++f) {
      for (int k = 0; k < 20; ++k) {
        generator.add(simulation.motion.imu((f + k / 20.0) * kFrame_s));
      }
      if (f == 0) continue;
      generator.add(simulation.motion.imu((f + 1) * kFrame_s));
      generator.add(simulation.frameAt(f));
    }
    return generator.finish();
  }
};

TEST(TrajectoryGenerator, BelievesAStartBySearchThatLaterScansBearOut) {
  SearchedRun searched;
  const Result result = searched.run();
  EXPECT_EQ(searched.matcher->searches, 1);
  EXPECT_EQ(result.frames_before_start, 0u);
  EXPECT_EQ(result.trajectory.size(), 200u);
  EXPECT_LT(searched.simulation.rmse(result.trajectory), 0.5 * kMapSigma_m);
}

TEST(TrajectoryGenerator, DropsAStartBySearchThatLaterScansDeny) {
  SearchedRun searched;
  searched.matcher->right_from_s = 0.25;
  const Result result = searched.run();
  EXPECT_EQ(searched.matcher->searches, 2);
  EXPECT_GT(result.frames_before_start, 5u);  // a second passes until the next search
  ASSERT_GT(result.trajectory.size(), 180u);
  EXPECT_LT(searched.simulation.rmse(result.trajectory), 0.5 * kMapSigma_m);
  EXPECT_EQ(result.diagnostics[0].match.refusal, MatchRefusal::kNotConfirmed);
  EXPECT_EQ(result.diagnostics.size(), 200u);
  EXPECT_EQ(result.online.size(), result.trajectory.size());
}

TEST(TrajectoryGenerator, ScansThatMatchButWouldBeNoStartDenyOneBySearch) {
  SearchedRun searched;
  searched.matcher->denied_at = 2;
  const Result result = searched.run();
  EXPECT_EQ(searched.matcher->searches, 2);
  EXPECT_GT(result.frames_before_start, 3u);
  EXPECT_LT(searched.simulation.rmse(result.trajectory), 0.5 * kMapSigma_m);
}

TEST(TrajectoryGenerator, RecordingTooShortToBearOutAStartHasNoTrajectory) {
  SearchedRun searched;
  searched.simulation.duration_s = 0.4;
  const Result result = searched.run();
  EXPECT_TRUE(result.trajectory.empty());
  EXPECT_NE(result.no_trajectory_reason.find("not confirmed"), std::string::npos)
      << result.no_trajectory_reason;
}

TEST(TrajectoryGenerator, StartsLateWhenTheFirstScansAreRefused) {
  Simulation simulation;
  simulation.matcher->available = [](double t) { return t > 2; };
  const Result result = simulation.run();
  EXPECT_EQ(result.frames_before_start, 20u);
  EXPECT_EQ(result.trajectory.size(), 180u);
  EXPECT_LT(simulation.rmse(result.trajectory), kMapSigma_m);
}

}  // namespace
}  // namespace paloc

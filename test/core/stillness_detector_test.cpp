#include "paloc/core/stillness_detector.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iostream>
#include <random>
#include <vector>

#include "euroc_data.h"
#include "shared_data.h"

namespace paloc {
namespace {

constexpr double kGravity_mps2 = 9.80665;

/// An IMU at 200 Hz with the noise of a data sheet, judged ten times a second.
class Stillness {
 public:
  // Runs for `duration_s` with a rate (rad/s), a sway of the force (m/s2), and an odometry speed
  // (m/s).
  void run(double duration_s, double rate, double sway, double speed_mps,
           bool with_odometry = true) {
    const int steps = static_cast<int>(duration_s * 200);
    for (int k = 0; k < steps; ++k) {
      ImuSample sample;
      sample.t_ns = t_ns_ += 5'000'000;
      const double t = secondsBetween(0, t_ns_);
      sample.omega_body = bias_gyro + noise(0.002) + Vec3(0, 0, rate);
      sample.acc_body =
          noise(0.02) + Vec3(sway * std::sin(12 * t), 0, kGravity_mps2 + sway * std::cos(9 * t));
      detector.addImu(sample);
      way_ += speed_mps * 0.005;
      if (k % 20 != 19) continue;
      if (with_odometry) {
        detector.addOdometry(t_ns_, {Vec3(way_, 0, 0) + noise(0.002), Mat3::Identity()}, true);
      }
      judged.push_back(detector.update(t_ns_, bias_gyro));
    }
  }
  // Share of instants at rest among the last `seconds`.
  double restShare(double seconds) const {
    const auto n = static_cast<std::ptrdiff_t>(seconds * 10);
    return static_cast<double>(std::count(judged.end() - n, judged.end(), true)) /
           static_cast<double>(n);
  }

  StillnessDetector detector{StillnessSettings()};
  Vec3 bias_gyro{0.01, -0.02, 0.005};
  std::vector<bool> judged;

 private:
  Vec3 noise(double sigma) { return sigma * Vec3(normal_(rng_), normal_(rng_), normal_(rng_)); }
  std::mt19937_64 rng_{3};
  std::normal_distribution<double> normal_;
  TimeNs t_ns_ = 0;
  double way_ = 0;
};

TEST(StillnessDetector, SeesARestFromBeginningToEnd) {
  Stillness s;
  s.run(5, 0.3, 1.0, 1.0);
  EXPECT_EQ(s.restShare(5), 0);
  s.run(4, 0, 0, 0);
  EXPECT_GE(s.restShare(3.4), 1.0) << "all but the first window";
  s.run(5, 0.3, 1.0, 1.0);
  EXPECT_EQ(s.restShare(4.8), 0);
}

TEST(StillnessDetector, AnEvenSlowMotionIsNoRest) {
  Stillness s;
  s.run(20, 0, 0, 0.1);
  EXPECT_EQ(s.restShare(20), 0);
}

TEST(StillnessDetector, AnEvenTurnIsNoRest) {
  Stillness s;
  s.run(10, 0.05, 0, 0, false);
  EXPECT_EQ(s.restShare(10), 0);
}

TEST(StillnessDetector, TheImuDecidesAloneWithoutOdometry) {
  Stillness s;
  s.run(3, 0, 0, 0, false);
  EXPECT_EQ(s.restShare(2.4), 1);
}

TEST(StillnessDetector, MeanForcePointsUpAtRest) {
  Stillness s;
  s.run(2, 0, 0, 0);
  const auto force = s.detector.meanForce(nsFromSeconds(1.5));
  ASSERT_TRUE(force.has_value());
  EXPECT_LT((*force - Vec3(0, 0, kGravity_mps2)).norm(), 0.01);
  EXPECT_FALSE(s.detector.meanForce(nsFromSeconds(3)).has_value());
}

TEST(StillnessDetector, OnARealHandheldImuOnlyTheFirstSevenSecondsAreRest) {
  std::ifstream file(sharedData() / "imu/avia_handheld_imu.txt");
  if (!file) GTEST_SKIP() << "no real IMU data at " << sharedData();
  StillnessDetector detector{StillnessSettings()};
  std::vector<double> rest_s;
  double t, start = -1, next = 0;
  ImuSample s;
  while (file >> t >> s.omega_body.x() >> s.omega_body.y() >> s.omega_body.z() >> s.acc_body.x() >>
         s.acc_body.y() >> s.acc_body.z()) {
    if (start < 0) start = t;
    s.t_ns = nsFromSeconds(t - start);
    s.acc_body *= kGravity_mps2;  // the file has it in g
    detector.addImu(s);
    if (t - start < next) continue;
    next += 0.1;
    if (detector.update(s.t_ns, Vec3::Zero())) rest_s.push_back(t - start);
  }
  ASSERT_FALSE(rest_s.empty());
  EXPECT_LT(rest_s.front(), 0.65);
  EXPECT_GT(rest_s.back(), 6.5);
  EXPECT_LT(rest_s.back(), 7.6);
  const double instants = (rest_s.back() - rest_s.front()) / 0.1;
  EXPECT_NEAR(static_cast<double>(rest_s.size()), instants + 1, 1.5) << "one interval, unbroken";
}

// A drone that is carried about before it flies; the truth says how fast it is. What is called rest
// must be one. Of the instants that are still in truth the detector leaves out those with the
// motors on, and the first half second of each rest.
TEST(StillnessDetector, OnEurocNoRestIsSeenInFlight) {
  const std::filesystem::path folder = sharedData() / "imu";
  const std::vector<ImuSample> samples = readEurocImu(folder / "euroc_mh05_imu0.txt");
  const std::vector<EurocTruth> truth = readEurocTruth(folder / "euroc_mh05_groundtruth.csv");
  if (samples.empty() || truth.empty()) GTEST_SKIP() << "no EuRoC data in " << folder;
  StillnessDetector detector{StillnessSettings()};
  auto row = truth.begin();
  TimeNs next_ns = samples.front().t_ns;
  int judged = 0, at_rest = 0, still = 0, both = 0;
  double fastest_mps = 0;
  for (const ImuSample& sample : samples) {
    detector.addImu(sample);
    if (sample.t_ns < next_ns) continue;
    next_ns += 100'000'000;
    while (row != truth.end() && row->t_ns < sample.t_ns) ++row;
    if (row == truth.begin() || row == truth.end()) {
      detector.update(sample.t_ns, truth.front().state.bias_gyro);
      continue;
    }
    const bool rest = detector.update(sample.t_ns, row->state.bias_gyro);
    // Still in truth: no faster than 2 cm/s through the window, as well as the truth knows.
    double speed_mps = 0;
    for (auto r = row; r->t_ns > sample.t_ns - 500'000'000 && r != truth.begin(); --r) {
      speed_mps = std::max(speed_mps, r->state.v_map.norm());
    }
    ++judged;
    if (rest) {
      ++at_rest;
      fastest_mps = std::max(fastest_mps, speed_mps);
    }
    if (speed_mps < 0.02) {
      ++still;
      if (rest) ++both;
    }
  }
  std::cout << "EuRoC MH05: " << judged << " instants judged, " << still << " still in truth, "
            << at_rest << " called rest, " << both << " of them still; fastest speed at a rest "
            << fastest_mps << " m/s\n";
  ASSERT_GT(judged, 1000);
  EXPECT_LT(fastest_mps, 0.02);
  EXPECT_EQ(both, at_rest);
  EXPECT_GT(at_rest, 20);
}

}  // namespace
}  // namespace paloc

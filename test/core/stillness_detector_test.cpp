#include "paloc/core/stillness_detector.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <random>
#include <vector>

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
  const char* folder = std::getenv("PALOC_SHARED_DATA");
  const std::filesystem::path data =
      folder ? folder : std::filesystem::path(PALOC_SOURCE_DIR) / "../shared/data";
  std::ifstream file(data / "imu/avia_handheld_imu.txt");
  if (!file) GTEST_SKIP() << "no real IMU data at " << data;
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

}  // namespace
}  // namespace paloc

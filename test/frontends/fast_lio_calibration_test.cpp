#include <gtest/gtest.h>

#include <random>

#include "recorded_lidar_imu.h"

namespace paloc {
namespace {

using namespace test::recorded;

constexpr double kDegree = M_PI / 180;
const Pose kTrueMount{Vec3(0.10, -0.05, 0.15), Mat3::Identity()};
const Pose kWrongMount{Vec3(0.12, -0.06, 0.15), so3::exp(kDegree* Vec3(1, -0.8, 1.2))};

FrontendSettings estimating(bool on) {
  FrontendSettings settings;
  settings.fast_lio.estimate_extrinsic = settings.fast_lio.estimate_time_offset = on;
  return settings;
}

/// From rest, and smoothly: turning about all axes.
test::Path calmWalk() {
  return [](double t) {
    const double s = std::max(0.0, t - seconds(kT0) - 1), start = s * s / (1 + s * s);
    const Vec3 position(1.5 * std::sin(0.6 * s), 0.8 * std::sin(0.9 * s), 0.15 * std::sin(1.3 * s));
    const Vec3 turn(0.25 * std::sin(1.9 * s), 0.2 * std::sin(1.5 * s), 0.9 * std::sin(0.8 * s));
    return Pose{start * position, so3::exp(start * turn)};
  };
}

void addNoise(obs::CObservationLidarScan& scan, std::mt19937& random) {
  std::normal_distribution<float> noise(0, 0.008F);
  for (std::size_t i = 0; i < scan.x.size(); ++i) {
    const float range = std::hypot(scan.x[i], scan.y[i], scan.z[i]);
    const float scale = 1 + noise(random) / range;
    scan.x[i] *= scale;
    scan.y[i] *= scale;
    scan.z[i] *= scale;
  }
}

/// Scans by a LiDAR that sits elsewhere than they say, and an IMU whose stamps are `late`.
std::vector<CObservation::Ptr> wrongRecording(const test::Path& path, int scans, TimeNs late) {
  Recording recording;
  std::mt19937 random(4);
  for (int i = 0; i < scans; ++i) {
    auto scan = std::make_shared<obs::CObservationLidarScan>(
        test::scanRoom(test::BoxRoom{}, path, kTrueMount, kT0 + i * kScan, kScan - kMs, 900, 32));
    addNoise(*scan, random);
    scan->sensorPoseOnRobot = toMrpt(kWrongMount);
    recording.add(scan);
  }
  const TimeNs end = kT0 + scans * kScan + 20 * kMs;
  for (TimeNs t = kT0 - 32 * kMs; t <= end; t += 5 * kMs) {
    const auto imu = imuOn(path, t);
    imu->timestamp = toMrptTime(t + late);
    recording.add(imu);
  }
  return recording.inOrder();
}

TEST(FastLioCalibration, FindsTheMountingAndTheClockAndHandsOnWhatIsRight) {
  const test::Path path = calmWalk();
  constexpr TimeNs kLate = 8 * kMs;
  const auto recording = wrongRecording(path, 120, kLate);
  const Output output = run(recording, estimating(true), "fast_lio");
  ASSERT_EQ(output.frames.size(), 120U);
  EXPECT_TRUE(output.noted("import the recording with --T-body-lidar")) << "told";
  EXPECT_TRUE(output.noted("ms late against the LiDAR's")) << "told";
  const OdometryFrame& last = output.frames.back();
  ASSERT_TRUE(last.scan);
  EXPECT_LT((last.scan->sensor_position_body - kTrueMount.position).norm(), 0.006);
  EXPECT_LT(test::worstOffWall({}, path(seconds(last.t_ns)), last.scan->points_body), 0.045)
      << "with 8 mm of noise";
  const Pose error = errorOf(path, output.frames[60], last);
  EXPECT_LT(error.position.norm(), 0.015);
  EXPECT_LT(so3::log(error.rotation).norm(), 0.004);

  const Output without = run(recording, estimating(false), "fast_lio");
  const Pose worse = errorOf(path, without.frames[60], without.frames.back());
  EXPECT_GT(worse.position.norm() + so3::log(worse.rotation).norm(), 0.02) << "it is needed";
}

TEST(FastLioCalibration, SamplesComeByTheLidarsClockAndInOrder) {
  constexpr TimeNs kLate = -9 * kMs;
  const Output output = run(wrongRecording(calmWalk(), 80, kLate), estimating(true), "fast_lio");
  ASSERT_EQ(output.frames.size(), 80U);
  TimeNs newest = 0;
  for (const FrontendEvent& event : output.events) {
    if (const auto* sample = std::get_if<ImuSample>(&event)) {
      EXPECT_GT(sample->t_ns, newest);
      newest = sample->t_ns;
      if (sample->t_ns < kT0 + 60 * kScan) continue;
      const ImuSample truth = test::imuOnPath(calmWalk(), sample->t_ns, 9.80665);
      EXPECT_LT((sample->omega_body - truth.omega_body).norm(), 0.02) << "2 ms would be 0.02";
    } else {
      const OdometryFrame& frame = std::get<OdometryFrame>(event);
      EXPECT_EQ((frame.t_ns - kT0 + kMs) % kScan, 0) << "the scan's own stamp";
      EXPECT_GE(newest, frame.t_ns);
    }
  }
}

TEST(FastLioCalibration, OfWhatIsRightItSaysSo) {
  const Output output = run(recordingOf(calmWalk(), 80), estimating(true), "fast_lio");
  EXPECT_TRUE(output.noted("fast_lio turns T_body_lidar by"));
  const Pose error = errorOf(calmWalk(), output.frames[5], output.frames.back());
  EXPECT_LT(error.position.norm(), 0.02);
  EXPECT_LT(so3::log(error.rotation).norm(), 0.005);
}

// A start so quick that the first scans fit no state of the filter: nothing is told from them.
TEST(FastLioCalibration, FromAWildStartItDoesNoHarm) {
  const Output output = run(recordingOf(test::sway(), 80), estimating(true), "fast_lio");
  const Pose error = errorOf(test::sway(), output.frames[5], output.frames.back());
  EXPECT_LT(error.position.norm(), 0.02);
  EXPECT_LT(so3::log(error.rotation).norm(), 0.005);
}

}  // namespace
}  // namespace paloc

#include <gtest/gtest.h>

#include <numbers>

#include "paloc/core/errors.h"
#include "paloc/frontends/mrpt_time.h"
#include "paloc/frontends/rawlog_stream.h"
#include "paloc/frontends/tum_file.h"
#include "paloc/tools/synth_recording.h"
#include "paloc/tools/synth_scene.h"
#include "paloc/tools/synth_sensor.h"
#include "paloc/tools/synth_walk.h"
#include "temp_dir.h"

namespace paloc::synth {
namespace {

constexpr TimeNs kStart = 1'700'000'000 * kNsPerSecond;

const Scene& building() {
  static const Scene scene = makeScene("building");
  return scene;
}

const Motion& walk() {
  static const Motion motion = makeWalk(building().route, 30, kStart, 7);
  return motion;
}

ImuModel perfectImu() {
  ImuModel model;
  model.noise = {0, 0, 0, 0};
  model.initial_bias_acc_mps2 = 0;
  model.initial_bias_gyro_radps = 0;
  return model;
}

TEST(SynthMotion, DerivativesMatchDifferences) {
  constexpr TimeNs kH = 200'000;
  constexpr double h = kH * 1e-9;
  for (int i = 0; i < 290; ++i) {
    const TimeNs t = kStart + 40'000'000 + i * kNsPerSecond / 10;
    const MotionState now = walk().at(t), before = walk().at(t - kH), after = walk().at(t + kH);
    const Vec6 d = boxminus(after.T_map_body, before.T_map_body) / (2 * h);
    EXPECT_LT((now.v_map - d.head<3>()).norm(), 2e-6) << i;
    EXPECT_LT((now.omega_body - d.tail<3>()).norm(), 2e-6) << i;
    EXPECT_LT((now.a_map - (after.v_map - before.v_map) / (2 * h)).norm(), 1e-4) << i;
  }
}

TEST(SynthMotion, StandsStillAtBothEnds) {
  for (const double t : {0.0, 0.5, 2.3, 28.3, 29.9}) {
    const MotionState state = walk().at(kStart + nsFromSeconds(t));
    EXPECT_LT(state.v_map.norm() + state.a_map.norm() + state.omega_body.norm(), 1e-8) << t;
  }
}

TEST(SynthMotion, WalksAtAPersonsPace) {
  double fastest = 0, turn = 0, sum = 0;
  int moving = 0;
  for (int i = 0; i < 3000; ++i) {
    const MotionState state = walk().at(kStart + i * kNsPerSecond / 100);
    const double speed = state.v_map.head<2>().norm();
    fastest = std::max(fastest, speed);
    turn = std::max(turn, state.omega_body.norm());
    if (speed > 0.5) sum += speed, ++moving;
  }
  EXPECT_LT(fastest, 1.5);
  EXPECT_NEAR(sum / moving, 1.05, 0.25);
  EXPECT_LT(turn, 2.5);
}

TEST(SynthMotion, KeepsClearOfTheScene) {
  const Raycaster raycaster(building().mesh);
  const Motion round = makeWalk(building().route, 180, kStart, 3);  // once round and more
  std::vector<Eigen::Vector3f> directions;
  for (int i = 0; i < 36; ++i) {
    directions.push_back(
        Eigen::AngleAxisf(0.1745F * static_cast<float>(i), Eigen::Vector3f::UnitZ()) *
        Eigen::Vector3f::UnitX());
  }
  std::vector<RayHit> hits(directions.size());
  for (int i = 0; i < 1800; ++i) {
    const Vec3 position = round.at(kStart + i * kNsPerSecond / 10).T_map_body.position;
    for (const double height : {0.3, 0.8, position.z()}) {
      raycaster.cast(Vec3(position.x(), position.y(), height), directions, hits);
      for (const RayHit& hit : hits) {
        ASSERT_GT(hit.distance_m, 0.25) << position.transpose() << " at height " << height;
      }
    }
  }
}

TEST(SynthImu, NoiseFreeSamplesIntegrateBackToTheTruth) {
  const TimeNs begin = kStart + 3 * kNsPerSecond;
  ImuModel model = perfectImu();
  model.rate_hz = 1000;  // at 200 Hz the trapezoidal rule itself is 1 mm off after 10 s of walking
  const auto imu = simulateImu(model, walk(), begin, begin + 10 * kNsPerSecond, 1);
  ASSERT_EQ(imu.size(), 10'001U);
  Pose pose = imu[0].state.T_map_body;
  Vec3 v = imu[0].state.v_map;
  const Vec3 gravity(0, 0, -kGravity);
  for (std::size_t i = 1; i < imu.size(); ++i) {
    const double dt = secondsBetween(imu[i - 1].sample.t_ns, imu[i].sample.t_ns);
    const Vec3 omega = (imu[i - 1].sample.omega_body + imu[i].sample.omega_body) / 2;
    const Mat3 next = pose.rotation * so3::exp(omega * dt);
    const Vec3 a =
        (pose.rotation * imu[i - 1].sample.acc_body + next * imu[i].sample.acc_body) / 2 + gravity;
    pose.position += v * dt + a * dt * dt / 2;
    v += a * dt;
    pose.rotation = next;
  }
  const Vec6 error = boxminus(pose, imu.back().state.T_map_body);
  EXPECT_LT(error.head<3>().norm(), 1e-4);
  EXPECT_LT(error.tail<3>().norm(), 1e-5);
}

TEST(SynthImu, SpecificForcePointsUpAtRest) {
  const auto imu = simulateImu(perfectImu(), walk(), kStart, kStart + kNsPerSecond, 1);
  for (const ImuTruth& row : imu) {
    const Vec3 up = row.state.T_map_body.rotation * row.sample.acc_body;
    EXPECT_LT((up - Vec3(0, 0, 9.80665)).norm(), 1e-6);
  }
}

TEST(SynthImu, NoiseHasTheDensityAsked) {
  ImuModel model;
  model.initial_bias_acc_mps2 = model.initial_bias_gyro_radps = 0;
  model.noise.accelerometer_bias_walk_mps3_sqrthz = model.noise.gyroscope_bias_walk_radps2_sqrthz =
      0;
  const Motion still({Pose{}}, 0.05, kStart);
  double acc = 0, gyro = 0;
  const auto imu = simulateImu(model, still, kStart, kStart + 60 * kNsPerSecond, 5);
  for (const ImuTruth& row : imu) {
    acc += (row.sample.acc_body - Vec3(0, 0, kGravity)).squaredNorm();
    gyro += row.sample.omega_body.squaredNorm();
  }
  const double n = 3.0 * static_cast<double>(imu.size());
  EXPECT_NEAR(std::sqrt(acc / n), 1.2e-3 * std::sqrt(200.0), 2e-4);
  EXPECT_NEAR(std::sqrt(gyro / n), 4.4e-5 * std::sqrt(200.0), 1e-5);
}

/// Whether a point lies on one of the mesh's triangles, within `tolerance` (m).
bool onSurface(const SceneMesh& mesh, const Vec3& p, double tolerance) {
  const auto vertex = [&](std::uint32_t i) {
    return Vec3(mesh.vertices[i].x, mesh.vertices[i].y, mesh.vertices[i].z);
  };
  for (const auto& t : mesh.triangles) {
    const Vec3 a = vertex(t[0]), u = vertex(t[1]) - a, w = vertex(t[2]) - a, n = u.cross(w);
    if (std::abs(n.dot(p - a)) > tolerance * n.norm()) continue;
    const double beta = n.dot((p - a).cross(w)) / n.squaredNorm();
    const double gamma = n.dot(u.cross(p - a)) / n.squaredNorm();
    constexpr double kEdge = -1e-2;
    if (beta > kEdge && gamma > kEdge && beta + gamma < 1 - kEdge) return true;
  }
  return false;
}

TEST(SynthLidar, PointsLieOnTheSceneAtTheirOwnTimes) {
  SensorModel sensor = makeSensor("os1-128");
  sensor.range_noise_m = 0;
  const Raycaster raycaster(building().mesh);
  const Surroundings surroundings(raycaster);
  const Pose T_body_lidar = defaultExtrinsic();
  const LidarSimulator lidar(sensor, T_body_lidar, building().mesh, surroundings, walk(), 1);
  const TimeNs stamp = kStart + 7 * kNsPerSecond;
  ASSERT_GT(walk().at(stamp).v_map.norm(), 0.5);
  const auto scan = lidar.scan(0, stamp);
  ASSERT_GT(scan->size(), 100'000U);
  EXPECT_EQ(scan->duration_ns, 99'902'300U);
  for (std::size_t i = 0; i < scan->size(); i += 331) {
    const double azimuth = std::atan2(scan->y[i], scan->x[i]);
    const double turn =
        azimuth > 1e-4 ? 1 - azimuth / (2 * std::numbers::pi) : -azimuth / (2 * std::numbers::pi);
    const int column = static_cast<int>(std::lround(turn * 1024)) % 1024;
    EXPECT_EQ(scan->dt_ns[i], sensor.columnDelay(column));
    const Pose T_map_lidar = walk().at(stamp + scan->dt_ns[i]).T_map_body * T_body_lidar;
    EXPECT_TRUE(
        onSurface(building().mesh, T_map_lidar * Vec3(scan->x[i], scan->y[i], scan->z[i]), 1e-4))
        << i;
  }
}

TEST(SynthLidar, RangeNoiseIsTheSensors) {
  SensorModel sensor = makeSensor("xt-32"), exact = sensor;
  exact.range_noise_m = 0;
  const Raycaster raycaster(building().mesh);
  const Surroundings surroundings(raycaster);
  const Motion still({walk().at(kStart).T_map_body}, 0.05, kStart);
  const auto noisy =
      LidarSimulator(sensor, Pose{}, building().mesh, surroundings, still, 1).scan(0, kStart);
  const auto clean =
      LidarSimulator(exact, Pose{}, building().mesh, surroundings, still, 1).scan(0, kStart);
  ASSERT_EQ(noisy->size(), clean->size());
  double sum_sq = 0;
  for (std::size_t i = 0; i < noisy->size(); ++i) {
    sum_sq += std::pow(std::hypot(noisy->x[i], noisy->y[i], noisy->z[i]) -
                           std::hypot(clean->x[i], clean->y[i], clean->z[i]),
                       2);
  }
  EXPECT_NEAR(std::sqrt(sum_sq / static_cast<double>(noisy->size())), 0.01, 0.0005);
}

TEST(SynthOdometry, DriftsAsToldOnAStraightWay) {
  std::vector<StampedPose> truth;
  for (int i = 0; i <= 100; ++i)
    truth.push_back({i * kNsPerSecond / 10, {Vec3(0.1 * i, 0, 0), Mat3::Identity()}});
  OdometryModel model;
  model.drift = 0.02;
  model.step_noise_m = model.step_noise_rad = 0;
  const auto odometry = simulateOdometry(model, truth, 4);
  EXPECT_EQ(odometry.front().pose.position, Vec3(Vec3::Zero()));
  EXPECT_NEAR((odometry.back().pose.position - truth.back().pose.position).norm(), 0.2, 0.01);
}

SynthSettings smallSettings(const std::filesystem::path& folder) {
  SynthSettings settings;
  settings.sensor = "vlp-16";
  settings.duration_s = 6;
  settings.survey.angular_step_deg = 3;
  settings.folder = folder;
  return settings;
}

void ignoreProgress(double, const std::string&) {}

TEST(SynthRecording, StampsAndOrderAreAsTold) {
  const test::TempDir folder;
  const SynthSummary summary = writeRecording(smallSettings(folder.path()), ignoreProgress);
  ASSERT_EQ(summary.scans, 60U);
  const auto truth = readTum(folder.path() / "truth.tum");
  ASSERT_EQ(truth.size(), 60U);
  std::vector<TimeNs> scan_ends, odometry_stamps, imu_stamps;
  RawlogStream stream(folder.path() / "recording.rawlog");
  TimeNs last = 0, first_scan = 0;
  while (const auto observation = stream.next()) {
    const TimeNs t = fromMrptTime(observation->timestamp);
    EXPECT_GE(t, last);
    last = t;
    if (observation->sensorLabel == "imu") imu_stamps.push_back(t);
    if (observation->sensorLabel == "odometry") odometry_stamps.push_back(t);
    if (const auto scan = std::dynamic_pointer_cast<obs::CObservationLidarScan>(observation)) {
      if (scan_ends.empty()) first_scan = t;
      scan_ends.push_back(t + scan->duration_ns);
    }
  }
  EXPECT_EQ(stream.end(), RawlogStream::End::kClean);
  ASSERT_EQ(scan_ends.size(), 60U);
  EXPECT_EQ(odometry_stamps, scan_ends);
  for (std::size_t i = 0; i < truth.size(); ++i) EXPECT_EQ(truth[i].t_ns, scan_ends[i]);
  EXPECT_LT(imu_stamps.front(), first_scan);
  EXPECT_GT(imu_stamps.back(), scan_ends.back());
  for (std::size_t i = 1; i < imu_stamps.size(); ++i)
    EXPECT_EQ(imu_stamps[i] - imu_stamps[i - 1], 5'000'000);
}

TEST(SynthRecording, SameSeedSameBytesOnAnyNumberOfThreads) {
  const test::TempDir folder;
  SynthSettings one = smallSettings(folder.path() / "one"),
                two = smallSettings(folder.path() / "two");
  SynthSettings other = smallSettings(folder.path() / "other");
  one.threads = 1;
  two.threads = 2;
  other.seed = 2;
  const SynthSummary summary = writeRecording(one, ignoreProgress);
  writeRecording(two, ignoreProgress);
  writeRecording(other, ignoreProgress);
  ASSERT_EQ(summary.files.size(), 5U);
  for (const auto& file : summary.files) {
    const std::string expected = test::readFile(file);
    ASSERT_FALSE(expected.empty()) << file;
    EXPECT_TRUE(expected == test::readFile(two.folder / file.filename())) << file;
    EXPECT_FALSE(expected == test::readFile(other.folder / file.filename())) << file;
  }
}

TEST(SynthRecording, FollowsAGivenTrajectory) {
  const test::TempDir folder;
  std::vector<StampedPose> path;
  for (int i = 0; i <= 40; ++i) {
    const double s = 0.1 * i;
    path.push_back(
        {kStart + i * kNsPerSecond / 10 + 37,  // off the 100 ns grid
         {Vec3(2 + s, 7.6 + 0.1 * std::sin(s), 1.2), so3::exp(Vec3(0, 0, 0.1 * std::cos(s)))}});
  }
  writeTum(folder.path() / "path.tum", path);
  SynthSettings settings = smallSettings(folder.path() / "out");
  settings.trajectory = folder.path() / "path.tum";
  const SynthSummary summary = writeRecording(settings, ignoreProgress);
  EXPECT_GT(summary.scans, 30U);
  EXPECT_LT(summary.scans, 40U);
  for (const StampedPose& pose : readTum(settings.folder / "truth.tum")) {
    const double s = secondsBetween(path.front().t_ns, pose.t_ns);
    if (s < 0.6 || s > 3.4) continue;  // where smoothing sees an end
    EXPECT_LT((pose.pose.position - Vec3(2 + s, 7.6 + 0.1 * std::sin(s), 1.2)).norm(), 0.005);
  }
}

TEST(SynthRecording, RefusesWhatIsWrong) {
  EXPECT_THROW(makeScene("castle"), UsageError);
  EXPECT_THROW(makeSensor("sonar"), UsageError);
  const test::TempDir folder;
  SynthSettings settings = smallSettings(folder.path());
  settings.duration_s = 0.3;
  writeRecording(settings, ignoreProgress);
  const std::string before = test::readFile(folder.path() / "recording.rawlog");
  settings.seed = 9;
  EXPECT_THROW(writeRecording(settings, ignoreProgress), UsageError);
  EXPECT_TRUE(before == test::readFile(folder.path() / "recording.rawlog"));
  settings.overwrite = true;
  writeRecording(settings, ignoreProgress);
  EXPECT_FALSE(before == test::readFile(folder.path() / "recording.rawlog"));
}

}  // namespace
}  // namespace paloc::synth

#pragma once

#include <cmath>
#include <numbers>
#include <random>
#include <string>

#include "paloc/core/mrpt_pose.h"
#include "paloc/core/so3.h"
#include "paloc/tools/report_data.h"

namespace paloc::test {

// A round through two rooms and a corridor: degenerate in the corridor, coasting where the map
// ends.
inline PoseFlag exampleFlag(double t_s) {
  if (t_s > 22 && t_s < 30) return PoseFlag::kDegenerate;
  if (t_s > 41 && t_s < 44.55) return PoseFlag::kCoasting;
  if (t_s > 43 && t_s < 45.05) return PoseFlag::kLost;
  return PoseFlag::kGood;
}

inline Pose examplePose(double t_s) {
  const double phase = 2 * std::numbers::pi * t_s / 60;
  const Vec3 position(9 * std::sin(phase) + 2 * std::sin(3 * phase),
                      5 * std::sin(2 * phase) + 0.4 * t_s / 6,
                      1.2 + 0.05 * std::sin(40 * phase) + 0.3 * std::sin(phase));
  return {position, so3::exp(Vec3(0, 0, phase))};
}

inline void addExampleFrame(Result& result, TimeNs t_ns, double t_s, std::mt19937_64& rng) {
  std::normal_distribution<double> normal;
  const PoseFlag flag = exampleFlag(t_s);
  TrajectoryPoint point;
  point.t_ns = t_ns;
  point.T_map_body = toMrpt(examplePose(t_s));
  point.flag = flag;
  const double grown =
      flag == PoseFlag::kCoasting || flag == PoseFlag::kLost ? 1 + 30 * (t_s - 41) : 1;
  const double sideways = flag == PoseFlag::kDegenerate ? 4 : 1;
  const double sigma = 0.006 * grown * (1 + 0.05 * std::abs(normal(rng)));
  for (int i = 0; i < 3; ++i) {
    point.covariance(i, i) = std::pow(sigma * (i == 0 ? sideways : 1), 2);
    point.covariance(i + 3, i + 3) = std::pow(0.0012 * std::sqrt(grown) * (i == 2 ? 1.5 : 1), 2);
  }
  FrameDiagnostics frame;
  frame.t_ns = t_ns;
  frame.scan_start_ns = t_ns - kNsPerSecond / 10;
  MapMatch& match = frame.match;
  match.points = 3900 + static_cast<int>(t_s * 3) % 100;
  match.overlap = 0.9 + 0.04 * std::sin(t_s) - (grown > 1 ? 0.6 : 0);
  match.matched = static_cast<int>(match.overlap * match.points);
  match.inliers = static_cast<int>(0.93 * match.matched);
  match.residual_rms_m = 0.019 + 0.002 * normal(rng) + (grown > 1 ? 0.05 : 0);
  match.refusal = grown > 1 ? MatchRefusal::kLowOverlap : MatchRefusal::kNone;
  for (std::size_t k = 0; k < 6; ++k) {
    match.directions[k].axis_body = Vec3::Unit(static_cast<Eigen::Index>(k % 3));
    match.directions[k].cls = DirectionClass::kFull;
  }
  if (flag == PoseFlag::kDegenerate) match.directions[0].cls = DirectionClass::kPartial;
  frame.guess_step_position = 0.008 * Vec3(normal(rng), normal(rng), 0.4 * normal(rng));
  frame.guess_step_rotation = 0.002 * normal(rng);
  result.trajectory.push_back(point);
  result.diagnostics.push_back(frame);
}

/// 600 frames at 10 Hz, with a word in every list; `<` and `&` in its texts.
inline ReportData exampleReport() {
  ReportData data;
  data.name = "floor <3> & roof.rawlog";
  data.frontend = "recorded";
  data.created = "2026-11-22 19:00 UTC";
  std::mt19937_64 rng(7);
  const TimeNs start_ns = 1645002364'537699938;
  for (int i = 0; i < 600; ++i) {
    addExampleFrame(data.result, start_ns + i * kNsPerSecond / 10, 0.1 * i, rng);
  }
  data.result.repairs.damped = 2;
  data.result.frames_before_start = 3;
  std::uniform_real_distribution<float> u(0, 1);
  for (int i = 0; i < 20000; ++i) {
    const float along = 26 * u(rng) - 13, height = 3 * u(rng);
    data.map_points.push_back({along, i % 2 ? 7.5F : -7.F, height});
    data.map_points.push_back({i % 2 ? 13.F : -13.F, 14.5F * u(rng) - 7.F, height});
    data.map_points.push_back({along, 14.5F * u(rng) - 7.F, i % 2 ? 0.F : 3.F});
  }
  data.unused = {{"CObservationIMU", "imu", "time goes backwards", 12},
                 {"CObservationImage", "camera_left", "not a sensor that is used", 1800}};
  data.notes = {"Point times: field \"t\", nanoseconds after the scan's stamp.",
                "The IMU's mean force is 9.81 m/s2 while at rest, which fits m/s2 & not g."};
  data.stages = {{"read rawlog", 600, 0.8, 2.1, 512},
                 {"deskew", 600, 0.4, 0.9, 251},
                 {"map match", 600, 4.1, 7.7, 2510},
                 {"smoother", 600, 0.31, 0.8, 190}};
  data.wall_time_s = 3.9;
  data.recording_time_s = 60;
  data.peak_rss_mb = 412;
  data.inputs = {{"recording", "/data/floor <3> & roof.rawlog", 1'234'567'890,
                  "fnv1a64:0123456789abcdef", "600 scans"},
                 {"prior map", "/data/map.ply", 33'000'000, "", "929,000 points"}};
  data.settings_yaml = "matcher:\n  max_points: 4000  # <after thinning>\n";
  data.command_line = "paloc replay 'floor <3> & roof.rawlog' --map map.ply -o result";
  data.versions = {{"paloc", "0.1.0"}, {"MRPT", "2.5.8"}};
  data.output_files = {{"trajectory.tum", "poses of the body in the map"}};
  return data;
}

}  // namespace paloc::test

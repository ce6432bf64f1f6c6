#pragma once

#include <mrpt/obs/CObservation.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>
#include <vector>

#include "paloc/core/mrpt_pose.h"
#include "paloc/frontends/CObservationLidarScan.h"
#include "paloc/frontends/rawlog_stream.h"
#include "paloc/map/point_cloud.h"
#include "run_program.h"
#include "temp_dir.h"

/// A small recording with its map, and runs of `paloc replay` on it and on what tests make of it.
namespace paloc::test {

using Words = std::vector<std::string>;
using Observations = std::vector<mrpt::obs::CObservation::Ptr>;

/// recording.rawlog (VLP-16, 50 scans, labels lidar, imu, odometry), map.ply and truth.tum, made
/// once for the test program.
inline const std::filesystem::path& demoFolder() {
  static const TempDir folder;
  static const std::filesystem::path demo = [] {
    const auto path = folder / "demo";
    const ProgramRun run = runPaloc({"synth", "--scene", "building", "--sensor", "vlp-16",
                                     "--duration", "5", "--map-spacing", "0.08", "-o", path});
    if (run.exit_code != 0) throw std::runtime_error("no demo recording: " + run.err);
    return path;
  }();
  return demo;
}

inline std::filesystem::path demoLog() { return demoFolder() / "recording.rawlog"; }
inline std::filesystem::path demoMap() { return demoFolder() / "map.ply"; }

/// All of it, to be changed at will.
inline Observations demoObservations() {
  RawlogStream stream(demoLog());
  Observations all;
  while (auto observation = stream.next()) all.push_back(std::move(observation));
  return all;
}

/// The first scan of a recording, in the body's frame, as a cloud.
inline PointCloud firstScan(const std::filesystem::path& log) {
  RawlogStream stream(log);
  while (const auto observation = stream.next()) {
    const auto scan = std::dynamic_pointer_cast<obs::CObservationLidarScan>(observation);
    if (!scan) continue;
    const Pose T_body_lidar = fromMrpt(scan->sensorPoseOnRobot);
    PointCloud cloud;
    for (std::size_t i = 0; i < scan->size(); ++i) {
      const Vec3 p = T_body_lidar * Vec3(scan->x[i], scan->y[i], scan->z[i]);
      cloud.points.push_back(
          {static_cast<float>(p.x()), static_cast<float>(p.y()), static_cast<float>(p.z())});
    }
    return cloud;
  }
  throw std::runtime_error(log.string() + " has no scan");
}

inline void writeLog(const std::filesystem::path& file, const Observations& observations) {
  RawlogWriter writer(file);
  for (const auto& observation : observations) writer.write(*observation);
  writer.close();
}

/// A replay with what it left.
struct ReplayRun : ProgramRun {
  std::filesystem::path folder;
  nlohmann::json summary;  ///< null if there is none

  std::size_t poses() const { return summary.at("poses"); }
  std::string sentence() const { return summary.at("sentence"); }
  std::string file(const std::string& name) const { return readFile(folder / name); }
  std::size_t tumRows() const {
    const std::string tum = file("trajectory.tum");
    return static_cast<std::size_t>(std::count(tum.begin(), tum.end(), '\n')) -
           tum.starts_with('#');
  }
  std::uint64_t unused(const std::string& reason) const {
    std::uint64_t count = 0;
    for (const auto& row : summary.at("unused")) {
      if (row.at("reason") == reason) count += row.at("count").get<std::uint64_t>();
    }
    return count;
  }
  bool noted(const std::string& part) const {
    return summary.at("notes").dump().find(part) != std::string::npos;
  }
};

/// What to replay, and how; the rest is the demo's.
struct ReplayCall {
  std::filesystem::path log = demoLog();
  std::filesystem::path map = demoMap();
  Words start = {"--init-tum", demoFolder() / "truth.tum"};
  Words more = {};
};

inline ReplayRun replayInto(const std::filesystem::path& folder, const ReplayCall& call,
                            const ProgramOptions& options = {}) {
  Words words = {"replay", call.log, "--map", call.map, "-o", folder};
  words.insert(words.end(), call.start.begin(), call.start.end());
  words.insert(words.end(), call.more.begin(), call.more.end());
  ReplayRun run{runPaloc(words, options), folder, {}};
  std::error_code ignored;
  if (std::filesystem::exists(folder / "summary.json", ignored)) {
    run.summary = nlohmann::json::parse(readFile(folder / "summary.json"));
  }
  return run;
}

}  // namespace paloc::test

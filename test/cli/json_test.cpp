#include <gtest/gtest.h>

#include <CLI/CLI.hpp>
#include <map>
#include <nlohmann/json.hpp>

#include "paloc/core/mrpt_pose.h"
#include "paloc/map/cloud_io.h"
#include "paloc/map/map_changes.h"
#include "paloc/tools/command.h"
#include "paloc/tools/rosbag_reader.h"
#include "paloc/tools/trajectory_csv.h"
#include "replay_demo.h"
#include "run_program.h"
#include "temp_dir.h"

namespace paloc {
namespace {

using test::ProgramRun;
using test::runPaloc;
using Words = std::vector<std::string>;

/// The sub-commands that take --json, as "eval traj".
void collectWithJson(const CLI::App& app, const std::string& name,
                     std::vector<std::string>& found) {
  if (app.get_option_no_throw("--json") != nullptr) found.push_back(name);
  for (const CLI::App* child : app.get_subcommands([](const CLI::App*) { return true; })) {
    collectWithJson(*child, name.empty() ? child->get_name() : name + " " + child->get_name(),
                    found);
  }
}

/// A smoother problem: a body that rests at the map's origin for a second.
std::string restingProblem() {
  std::string text = "NOISE 0.0012 0.000132 5e-05 5e-06\n";
  for (int k = 0; k <= 10; ++k) {
    const std::string node = std::to_string(k);
    const std::string t = std::to_string(0.1 * k);
    text += "STATE " + node + " " + t + " 0 0 0 0 0 0 1 0 0 0\n";
    if (k > 0) text += "ODOM " + std::to_string(k - 1) + " " + node + " 0 0 0 0 0 0 1 0.002 0.01\n";
    text += "MAP " + node + " 0 0 0 0 0 0 1 0.004 0.02\n";
    for (int i = 0; i < 20; ++i) {
      text += "IMU " + std::to_string(0.1 * k + 0.005 * i) + " 0 0 9.81 0 0 0\n";
    }
  }
  return text;
}

/// Two scans of 100 points as a folder of KITTI clouds with times.txt, and as a KITTI drive.
void writeForeignRecordings(const test::TempDir& dir) {
  namespace fs = std::filesystem;
  const std::vector<float> cloud(400, 3.5F);
  const std::string bytes(reinterpret_cast<const char*>(cloud.data()), 4 * cloud.size());
  const fs::path clouds = dir / "clouds", drive = dir / "drive";
  const fs::path velodyne = drive / "velodyne_points", oxts = drive / "oxts";
  for (const auto& folder : {clouds, velodyne / "data", oxts / "data"})
    fs::create_directories(folder);
  const std::string stamps = "2011-09-26 13:02:25.000000000\n2011-09-26 13:02:25.100000000\n";
  for (const char* name : {"0000000000", "0000000001"}) {
    const std::string bin = std::string(name) + ".bin", txt = std::string(name) + ".txt";
    test::writeFile(clouds / bin, bytes);
    test::writeFile(velodyne / "data" / bin, bytes);
    // lat lon alt roll pitch yaw, velocities, accelerations, rates, accuracies, states
    test::writeFile(oxts / "data" / txt,
                    "49 8 110 0 0 0 0 0 0 0 0 0 0 9.81 0 0 9.81 0 0 0 0 0 0 1 1 4 4 4 4 0\n");
  }
  for (const char* file : {"timestamps.txt", "timestamps_start.txt", "timestamps_end.txt"}) {
    test::writeFile(velodyne / file, stamps);
  }
  test::writeFile(oxts / "timestamps.txt", stamps);
  test::writeFile(drive / "calib_imu_to_velo.txt", "R: 1 0 0 0 1 0 0 0 1\nT: 0 0 0\n");
  test::writeFile(dir / "times.txt", "0000000000.bin 1.0\n0000000001.bin 1.1\n");
}

/// The true trajectory as a result's trajectory_cov.csv.
void writeCovariantTruth(const test::TempDir& dir) {
  std::vector<TrajectoryPoint> points;
  for (const StampedPose& pose : readTum(dir / "demo/truth.tum")) {
    TrajectoryPoint point;
    point.t_ns = pose.t_ns;
    point.T_map_body = toMrpt(pose.pose);
    point.covariance = Mat6::Identity();
    points.push_back(point);
  }
  test::writeFile(dir / "trajectory_cov.csv", trajectoryCsv(points));
}

/// A sound call of each other sub-command that takes --json, on a recording in `dir`; without it.
std::map<std::string, Words> soundCalls(const test::TempDir& dir) {
  const std::string log = dir / "demo/recording.rawlog";
  const std::string truth = dir / "demo/truth.tum";
  return {
      {"info", {"info", log}},
      {"check", {"check", log}},
      {"replay",
       {"replay", log, "--map", dir / "demo/map.ply", "--init-tum", truth, "-o", dir / "result"}},
      {"import clouds",
       {"import", "clouds", dir / "clouds", "--times", dir / "times.txt", "-o",
        dir / "clouds.rawlog"}},
      {"export rosbag", {"export", "rosbag", log, "-o", dir / "json.bag"}},
      {"import rosbag", {"import", "rosbag", dir / "demo.bag", "-o", dir / "rosbag.rawlog"}},
      {"import kitti", {"import", "kitti", dir / "drive", "-o", dir / "kitti.rawlog"}},
      {"eval traj", {"eval", "traj", truth, truth}},
      {"eval covariance", {"eval", "covariance", truth, dir / "trajectory_cov.csv"}},
      {"eval changes", {"eval", "changes", dir / "changes.json", dir / "changes.ply"}},
      {"config describe", {"config", "describe"}},
      {"map info", {"map", "info", dir / "demo/map.ply"}},
      {"map locate",
       {"map", "locate", dir / "scan.pcd", "--map", dir / "demo/map.ply", "--init", "auto"}},
      {"map convert", {"map", "convert", dir / "demo/map.ply", dir / "map.pcd"}},
      {"bench endurance", {"bench", "endurance", "--updates", "100"}},
      {"bench smoother", {"bench", "smoother", "--problem", dir / "resting.problem"}},
      {"bench frontends", {"bench", "frontends", "--log", log, "--truth", truth}},
      {"bench covariance",
       {"bench", "covariance", "--places", "room", "--seeds", "1", "--duration", "2"}},
      {"bench degeneracy",
       {"bench", "degeneracy", "--scenes", "room", "--sensors", "vlp-16", "--poses", "1"}},
      {"bench start",
       {"bench", "start", "--scene", "room", "--sensor", "vlp-16", "--places", "1", "--partial",
        "0", "--wrong", "0", "--storeys", "0"}},
      {"bench corridor", {"bench", "corridor", "--sensor", "vlp-16", "--length", "5"}},
      {"bench registration",
       {"bench", "registration", "--map-points", "20000", "--places", "2", "--threads", "1"}},
  };
}

void expectOneObject(const std::string& name, const ProgramRun& run) {
  EXPECT_LE(run.exit_code, 1) << name << ": " << run.err;
  const auto json = nlohmann::json::parse(run.out, nullptr, false);
  EXPECT_TRUE(json.is_object()) << name << " printed: " << run.out.substr(0, 300);
}

TEST(Json, IsOneObjectOnStandardOutputAndNothingElse) {
  const test::TempDir dir;
  expectOneObject("synth", runPaloc({"synth", "--scene", "building", "--sensor", "vlp-16",
                                     "--duration", "2", "-o", dir / "demo", "--json"}));
  test::writeFile(dir / "resting.problem", restingProblem());
  writeForeignRecordings(dir);
  if (builtWithRosbag()) {
    runPaloc({"export", "rosbag", dir / "demo/recording.rawlog", "-o", dir / "demo.bag"});
  }
  savePcd(dir / "scan.pcd", test::firstScan(dir / "demo/recording.rawlog"));
  writeCovariantTruth(dir);
  test::writeFile(dir / "changes.json", R"({"objects": [], "missing_from_map": []})");
  saveChanges(dir / "changes.ply", {});

  CLI::App app;
  const auto commands = allCommands();
  for (const auto& command : commands) command->registerOn(app);
  std::vector<std::string> with_json;
  collectWithJson(app, "", with_json);
  const auto calls = soundCalls(dir);
  for (const std::string& name : with_json) {
    if (name == "synth") continue;  // made the recording above
    if (name.ends_with("rosbag") && !builtWithRosbag()) continue;
    const auto call = calls.find(name);
    if (call == calls.end()) {
      ADD_FAILURE() << "paloc " << name << " takes --json: add a call of it to this test";
      continue;
    }
    Words words = call->second;
    words.emplace_back("--json");
    expectOneObject(name, runPaloc(words));
  }
}

}  // namespace
}  // namespace paloc

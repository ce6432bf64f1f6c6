#include <gtest/gtest.h>

#include <limits>

#include "paloc/frontends/tum_file.h"
#include "paloc/map/cloud_io.h"
#include "replay_demo.h"

/// Where the work begins and ends: files that are asked for, the pose to start from, the folder to
/// write to.
namespace paloc {
namespace {

using test::demoMap;
using test::ReplayCall;
using test::ReplayRun;

// One sentence on standard error, and nothing else anywhere.
void expectRefused(const ReplayRun& run, int exit_code, const std::string& sentence) {
  EXPECT_EQ(run.exit_code, exit_code) << run.err;
  EXPECT_EQ(run.out, "");
  EXPECT_TRUE(run.err.starts_with("paloc: ")) << run.err;
  EXPECT_EQ(std::count(run.err.begin(), run.err.end(), '\n'), 1) << run.err;
  EXPECT_NE(run.err.find(sentence), std::string::npos) << run.err;
}

class ReplayStart : public testing::Test {
 protected:
  ReplayRun replay(const ReplayCall& call) { return test::replayInto(dir_ / "result", call); }
  ReplayRun withMap(const std::filesystem::path& map) {
    ReplayCall call;
    call.map = map;
    return replay(call);
  }
  ReplayRun withLog(const std::filesystem::path& log) {
    ReplayCall call;
    call.log = log;
    return replay(call);
  }
  ReplayRun withOptions(test::Words start, test::Words more = {}) {
    ReplayCall call;
    call.start = std::move(start);
    call.more = std::move(more);
    return replay(call);
  }
  test::TempDir dir_;
};

TEST_F(ReplayStart, MapThatCannotBeReadIsNamed) {
  const std::string map = test::readFile(demoMap());
  expectRefused(withMap(dir_ / "no.ply"), 3, "no.ply: cannot be opened: No such file");
  expectRefused(withMap(dir_.path()), 3, dir_.path().string() + ": is a folder");
  expectRefused(withMap(dir_.write("empty.ply", "")), 3, "empty.ply: is empty");
  expectRefused(withMap(dir_.write("cut.ply", map.substr(0, map.size() / 3))), 3,
                "cut.ply: its header promises ");
  expectRefused(withMap(dir_.write("other.ply", "plx" + map.substr(3))), 3,
                "other.ply: does not begin with 'ply'");
  expectRefused(withMap(test::demoLog()), 3, "is no point cloud in a format that is known");
}

TEST_F(ReplayStart, PointsOfTheMapThatAreNoNumbersAreCounted) {
  PointCloud cloud = loadCloud(demoMap());
  for (std::size_t k = 0; k < 100; ++k) {
    cloud.points[10 * k].y = std::numeric_limits<float>::quiet_NaN();
  }
  savePly(dir_ / "nan.ply", cloud, "with holes");
  const ReplayRun run = withMap(dir_ / "nan.ply");
  EXPECT_EQ(run.exit_code, 0) << run.err << run.out;
  EXPECT_EQ(run.poses(), 50U);
  EXPECT_EQ(run.unused("not finite"), 100U);
  EXPECT_NE(run.out.find("100 x point 'nan.ply': not finite"), std::string::npos) << run.out;
}

// A survey in UTM coordinates, of which a float holds no more than half a metre.
TEST_F(ReplayStart, MapFarFromItsOriginIsAsGood) {
  const Vec3 away(512'345.25, 4'612'345.5, 301);
  PointCloud cloud = loadCloud(demoMap());
  cloud.origin += away;
  savePly(dir_ / "utm.ply", cloud, "far");
  auto truth = readTum(test::demoFolder() / "truth.tum");
  for (StampedPose& pose : truth) pose.pose.position += away;
  writeTum(dir_ / "utm.tum", truth);
  ReplayCall call;
  call.map = dir_ / "utm.ply";
  call.start = {"--init-tum", dir_ / "utm.tum"};
  const ReplayRun far = replay(call);
  EXPECT_EQ(far.exit_code, 0) << far.err << far.out;
  EXPECT_NE(far.file("report.html").find("<image"), std::string::npos);
  const auto poses = readTum(far.folder / "trajectory.tum");
  ASSERT_EQ(poses.size(), truth.size());
  for (std::size_t k = 0; k < poses.size(); ++k) {
    EXPECT_LT((poses[k].pose.position - truth[k].pose.position).norm(), 0.02) << k;
  }
}

TEST_F(ReplayStart, RecordingThatIsNotThereIsNamed) {
  expectRefused(withLog(dir_ / "no.rawlog"), 3, "no.rawlog: no such file");
  expectRefused(withLog(dir_.path()), 3, dir_.path().string() + ": is a folder");
}

TEST_F(ReplayStart, FolderWithoutScansCannotBeImported) {
  std::filesystem::create_directory(dir_ / "empty");
  const auto times = dir_.write("times.txt", "0.pcd 1.0\n");
  const auto run = test::runPaloc(
      {"import", "clouds", dir_ / "empty", "--times", times, "-o", dir_ / "x.rawlog"});
  EXPECT_EQ(run.exit_code, 3);
  EXPECT_NE(run.err.find("empty: none of the scans that "), std::string::npos) << run.err;
  EXPECT_FALSE(std::filesystem::exists(dir_ / "x.rawlog"));
}

TEST_F(ReplayStart, WithoutAnInitialPoseThereIsNoLocalization) {
  const ReplayRun run = withOptions({});
  EXPECT_EQ(run.exit_code, 4);
  EXPECT_EQ(run.summary.at("status"), "no localization");
  EXPECT_EQ(run.sentence(),
            "no initial pose was given (--init-pose, --init-tum, --init-position or --init auto).");
  EXPECT_NE(run.err.find("note: LiDAR 'lidar'"), std::string::npos) << run.err;
  EXPECT_EQ(run.summary.at("map_factors").at("refused").at("not tried"), 50);
  EXPECT_FALSE(std::filesystem::exists(run.folder / "trajectory.tum"));
}

// The recording's first 2.5 s stand still: only then is a start by search borne out.
TEST_F(ReplayStart, IsFoundFromWhateverIsKnown) {
  const auto truth = readTum(test::demoFolder() / "truth.tum");
  const Pose& first = truth.front().pose;
  const auto words = [&](const Vec3& off) {
    const Vec3 at = first.position + off;
    return std::to_string(at.x()) + ',' + std::to_string(at.y()) + ',' + std::to_string(at.z());
  };
  const double yaw_deg = std::atan2(first.rotation(1, 0), first.rotation(0, 0)) * 180 / M_PI;
  for (const test::Words& start :
       {test::Words{"--init", "auto"}, test::Words{"--init-position=" + words(Vec3(0.4, -0.4, 0))},
        test::Words{"--init-pose=" + words(Vec3(2, 2, 0.5)) + ',' + std::to_string(yaw_deg + 40) +
                    ",0,0"}}) {
    const ReplayRun run = withOptions(start, {"--overwrite"});
    EXPECT_EQ(run.exit_code, 0) << start[0] << ": " << run.err << run.out;
    const auto poses = readTum(run.folder / "trajectory.tum");
    ASSERT_EQ(poses.size(), truth.size()) << start[0];
    for (std::size_t k = 0; k < poses.size(); ++k) {
      EXPECT_LT((poses[k].pose.position - truth[k].pose.position).norm(), 0.02) << k;
    }
    EXPECT_NE(run.file("report.html").find(start[0]), std::string::npos) << "how it was called";
  }
}

TEST_F(ReplayStart, RecordingOfAnotherPlaceIsNotLocalized) {
  const auto made = test::runPaloc({"synth", "--scene", "room", "--sensor", "vlp-16", "--duration",
                                    "3", "--map-spacing", "0.08", "-o", dir_ / "room"});
  ASSERT_EQ(made.exit_code, 0) << made.err;
  ReplayCall call;
  call.log = dir_ / "room/recording.rawlog";
  call.start = {"--init", "auto"};
  const ReplayRun run = replay(call);
  EXPECT_EQ(run.exit_code, 4) << run.out;
  EXPECT_NE(run.sentence().find("no place in the map was believed"), std::string::npos)
      << run.sentence();
}

TEST_F(ReplayStart, InitialPoseFarOffIsRefusedWithAReason) {
  const ReplayRun run = withOptions({"--init-pose=40,40,30,0,0,0"});
  EXPECT_EQ(run.exit_code, 4);
  EXPECT_NE(run.sentence().find("the initial pose was refused at each of 50 scans tried, the last "
                                "time: outside the map"),
            std::string::npos)
      << run.sentence();
}

TEST_F(ReplayStart, WrongCallsAreUsageErrors) {
  expectRefused(withOptions({"--init-pose=1,2,3"}), 2,
                "--init-pose: '1,2,3' is not x,y,z,yaw,pitch,roll");
  expectRefused(withOptions({"--init-position=1,2,3,4"}), 2,
                "--init-position: '1,2,3,4' is not x,y,z (m)");
  EXPECT_EQ(withOptions({"--init", "auto", "--init-pose=0,0,0,0,0,0"}).exit_code, 2);
  expectRefused(withOptions({}, {"--frontend", "nope"}), 2,
                "there are: 'fast_lio', 'icp', 'lio_sam', 'recorded'");
  expectRefused(withOptions({}, {"--from", "3", "--to", "2"}), 2, "--to must be later than --from");
  const auto config = dir_.write("site.yaml", "matcher:\n  max_point: 3\n");
  expectRefused(withOptions({}, {"--config", config}), 2,
                "site.yaml:2: matcher.max_point: unknown key; did you mean 'matcher.max_points'?");
}

TEST_F(ReplayStart, SpanOutsideTheRecordingIsSaid) {
  const ReplayRun run = withOptions({}, {"--from", "100"});
  EXPECT_EQ(run.exit_code, 3);
  EXPECT_NE(run.sentence().find("--from and --to leave nothing of the recording"),
            std::string::npos);
  EXPECT_EQ(run.summary.at("recording_s"), 0);
}

TEST_F(ReplayStart, FolderThatCannotBeWrittenToIsNamed) {
  const auto file = dir_.write("file", "mine");
  expectRefused(test::replayInto("/proc/paloc_result", {}), 3, "/proc/paloc_result: ");
  expectRefused(test::replayInto(file / "result", {}), 3, "result: cannot make this folder");
  expectRefused(test::replayInto(file, {}), 2, "file: is a file, not a folder");
  EXPECT_EQ(test::readFile(file), "mine");
}

TEST_F(ReplayStart, NothingIsOverwrittenUnasked) {
  dir_.write("result/mine.txt", "mine");
  expectRefused(replay({}), 2, "there is something in this folder already");
  ReplayCall call;
  call.more = {"--overwrite"};
  EXPECT_EQ(replay(call).exit_code, 0);
  EXPECT_EQ(test::readFile(dir_ / "result/mine.txt"), "mine");
}

TEST_F(ReplayStart, FullDiskIsSaidAndTheFiguresAreStillPrinted) {
  for (const char* name : {"trajectory.tum", "diagnostics.csv", "map.ply", "report.html"}) {
    const auto folder = dir_ / (std::string("full_") + name);
    std::filesystem::create_directory(folder);
    std::filesystem::create_symlink("/dev/full", folder / name);
    ReplayCall call;
    call.more = {"--overwrite"};
    const ReplayRun run = test::replayInto(folder, call);
    EXPECT_EQ(run.exit_code, 3) << name << ": " << run.err;
    EXPECT_NE(run.err.find("paloc: "), std::string::npos) << run.err;
    EXPECT_NE(run.err.find((folder / name).string()), std::string::npos) << run.err;
    EXPECT_TRUE(run.out.starts_with("good: All 50 poses")) << run.out;
  }
}

}  // namespace
}  // namespace paloc

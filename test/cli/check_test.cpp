#include <gtest/gtest.h>

#include "replay_demo.h"

// `paloc check`, and `paloc synth --fault` as its counterpart, as a user calls them.
namespace paloc {
namespace {

using test::Words;

std::filesystem::path recordingWith(const test::TempDir& dir, const Words& faults) {
  Words words = {"synth",  "--scene", "room", "--sensor",   "vlp-16",      "--duration",    "12",
                 "--seed", "4",       "-o",   dir / "demo", "--overwrite", "--map-spacing", "0.2"};
  for (const std::string& fault : faults) {
    words.emplace_back("--fault");
    words.push_back(fault);
  }
  const test::ProgramRun run = test::runPaloc(words);
  EXPECT_EQ(run.exit_code, 0) << run.err;
  return dir / "demo" / "recording.rawlog";
}

nlohmann::json jsonOf(const test::ProgramRun& run) {
  return nlohmann::json::parse(run.out, nullptr, false);
}

TEST(CheckCli, FindsNothingInASoundRecording) {
  const test::TempDir dir;
  const auto log = recordingWith(dir, {});
  const test::ProgramRun run = test::runPaloc({"check", log});
  EXPECT_EQ(run.exit_code, 0) << run.out;
  EXPECT_NE(run.out.find("nothing wrong found"), std::string::npos);
  const test::ProgramRun again = test::runPaloc({"check", log, "--json"});
  EXPECT_EQ(again.exit_code, 0);
  const auto json = jsonOf(again);
  EXPECT_TRUE(json.at("findings").empty());
  ASSERT_EQ(json.at("motion").size(), 2U);  // scans and odometry
  EXPECT_EQ(json.at("motion")[0].at("sensor"), "lidar");
  EXPECT_NEAR(json.at("motion")[0].at("imu_late_s").get<double>(), 0, 1.5e-3);
}

TEST(CheckCli, NamesSeveralFaultsWithTheirRemedies) {
  const test::TempDir dir;
  const auto log = recordingWith(dir, {"imu-g", "clock-offset=0.01", "lidar-gap=6,6.5"});
  const test::ProgramRun run = test::runPaloc({"check", log, "--json"});
  EXPECT_EQ(run.exit_code, 1);
  const auto json = jsonOf(run);
  std::map<std::string, nlohmann::json> found;
  for (const auto& finding : json.at("findings")) {
    found[finding.at("check").get<std::string>() + " " + finding.at("label").get<std::string>()] =
        finding;
  }
  ASSERT_EQ(found.size(), 4U) << json.dump(1);
  const auto& unit = found.at("acceleration-unit imu");
  EXPECT_EQ(unit.at("severity"), "error");
  EXPECT_EQ(unit.at("unit"), "m/s2");
  EXPECT_NE(unit.at("sentence").get<std::string>().find("multiply it by 9.80665"),
            std::string::npos);
  EXPECT_NEAR(found.at("clock-offset lidar").at("value").get<double>(), 0.01, 1e-3);
  EXPECT_NEAR(found.at("clock-offset odometry").at("value").get<double>(), 0.01, 2e-3);
  EXPECT_NEAR(found.at("gaps lidar").at("value").get<double>(), 0.6, 0.01);
  EXPECT_FALSE(found.at("gaps lidar").at("t_s").is_null());
}

TEST(CheckCli, ComparesTheMapWithTheScans) {
  const test::TempDir dir;
  EXPECT_EQ(test::runPaloc({"check", test::demoLog(), "--map", test::demoMap()}).exit_code, 0);
  std::string millimetres;
  for (int i = 0; i < 2000; ++i) millimetres += std::to_string(50 * i) + " 0 " + "1200\n";
  test::writeFile(dir / "mm.xyz", millimetres);
  const auto run = test::runPaloc({"check", test::demoLog(), "--map", dir / "mm.xyz"});
  EXPECT_EQ(run.exit_code, 1);
  EXPECT_NE(run.out.find("map-scale"), std::string::npos) << run.out;
  EXPECT_EQ(test::runPaloc({"check", test::demoLog(), "--map", dir / "none"}).exit_code, 3);
}

TEST(CheckCli, TellsADamagedRecording) {
  const test::TempDir dir;
  const std::string whole = test::readFile(test::demoLog());
  test::writeFile(dir / "cut.rawlog", whole.substr(0, whole.size() / 2));
  const test::ProgramRun run = test::runPaloc({"check", dir / "cut.rawlog"});
  EXPECT_EQ(run.exit_code, 1);
  EXPECT_NE(run.out.find("damaged"), std::string::npos);
}

TEST(CheckCli, ExitCodesOfWrongCalls) {
  const test::TempDir dir;
  EXPECT_EQ(test::runPaloc({"check"}).exit_code, 2);
  EXPECT_EQ(test::runPaloc({"check", dir / "none.rawlog"}).exit_code, 3);
  test::writeFile(dir / "empty.rawlog", "");
  EXPECT_EQ(test::runPaloc({"check", dir / "empty.rawlog"}).exit_code, 3);
  EXPECT_EQ(test::runPaloc({"check", test::demoLog(), "--set", "frontend.nothing=1"}).exit_code, 2);
  const test::ProgramRun unknown =
      test::runPaloc({"synth", "--fault", "nothing", "-o", dir / "demo"});
  EXPECT_EQ(unknown.exit_code, 2);
  EXPECT_NE(unknown.err.find("clock-offset"), std::string::npos);  // it lists those there are
}

TEST(CheckCli, ReplayTellsWhatTheCheapChecksFind) {
  const test::TempDir dir;
  test::ReplayCall call;
  call.log = recordingWith(dir, {"clock-offset=0.02"});
  call.map = dir / "demo/map.ply";
  call.start = {"--init-tum", dir / "demo/truth.tum"};
  const test::ReplayRun run = test::replayInto(dir / "result", call);
  ASSERT_FALSE(run.summary.is_null()) << run.err;
  ASSERT_EQ(run.summary.at("findings").size(), 1U) << run.summary.at("findings").dump(1);
  EXPECT_EQ(run.summary.at("findings")[0].at("check"), "clock-offset");
  EXPECT_EQ(run.summary.at("findings")[0].at("label"), "odometry");
  EXPECT_TRUE(run.noted("20.") || run.noted("19.")) << run.summary.at("notes").dump(1);
}

}  // namespace
}  // namespace paloc

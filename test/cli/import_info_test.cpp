#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "run_program.h"
#include "temp_dir.h"

namespace paloc {
namespace {

using test::runPaloc;

std::string scan(const std::string& fields) {
  return "VERSION 0.7\nFIELDS x y z " + fields +
         "\nSIZE 4 4 4 4\nTYPE F F F U\nCOUNT 1 1 1 1\nWIDTH 2\nHEIGHT 1\nPOINTS 2\n"
         "DATA ascii\n1 2 3 0\n4 5 6 90000000\n";
}

TEST(ImportAndInfo, TellTheTruthByTheirExitCodes) {
  const test::TempDir folder;
  folder.write("scans/0.pcd", scan("t"));
  folder.write("scans/1.pcd", scan("t"));
  const std::string times = folder.write("times.txt", "0.pcd 10.0\n1.pcd 10.1\n").string();
  const std::string scans = (folder / "scans").string();
  const std::string log = (folder / "log.rawlog").string();
  const std::vector<std::string> import{"import", "clouds", scans, "--times",
                                        times,    "-o",     log,   "--json"};
  const auto good = runPaloc(import);
  EXPECT_EQ(good.exit_code, 0) << good.err;
  const auto summary = nlohmann::json::parse(good.out);
  EXPECT_EQ(summary["scans"]["written"], 2);
  EXPECT_EQ(summary["scans"]["with_point_times"], 2);
  EXPECT_NE(summary["notes"].dump().find("nanoseconds after the scan's stamp"), std::string::npos);
  EXPECT_EQ(runPaloc(import).exit_code, 2);  // the rawlog exists

  auto partly = import;
  partly.push_back("--overwrite");
  folder.write("scans/1.pcd", "broken");
  EXPECT_EQ(runPaloc(partly).exit_code, 1);
  const auto info = runPaloc({"info", log, "--json"});
  EXPECT_EQ(info.exit_code, 0) << info.err;
  const auto sensors = nlohmann::json::parse(info.out)["sensors"];
  ASSERT_EQ(sensors.size(), 1U);
  EXPECT_EQ(sensors[0]["class"], "CObservationLidarScan");
  EXPECT_EQ(sensors[0]["points"]["max"], 2);

  const std::string bytes = test::readFile(log);
  folder.write("cut.rawlog", bytes + bytes.substr(0, bytes.size() / 2));
  const auto cut = runPaloc({"info", (folder / "cut.rawlog").string()});
  EXPECT_EQ(cut.exit_code, 1);
  EXPECT_NE(cut.out.find("object 2: the file ends inside it"), std::string::npos) << cut.out;
  EXPECT_EQ(cut.err, "");
  for (const char* wrong : {"missing.rawlog", "times.txt", "scans"}) {
    const auto refused = runPaloc({"info", (folder / wrong).string()});
    EXPECT_EQ(refused.exit_code, 3) << wrong;
    EXPECT_EQ(std::count(refused.err.begin(), refused.err.end(), '\n'), 1) << refused.err;
  }
}

}  // namespace
}  // namespace paloc

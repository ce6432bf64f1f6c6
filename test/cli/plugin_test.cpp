#include <gtest/gtest.h>

#include <fstream>

#include "run_program.h"
#include "temp_dir.h"

namespace paloc {
namespace {

test::ProgramRun benchOf(const std::vector<std::string>& more) {
  std::vector<std::string> arguments{"bench",      "frontends", "--sensor", "xt-32",
                                     "--duration", "8",         "--seeds",  "1"};
  arguments.insert(arguments.end(), more.begin(), more.end());
  return test::runPaloc(arguments);
}

TEST(Plugin, BringsAFrontend) {
  const auto run = benchOf({"--plugin", PALOC_EXAMPLE_PLUGIN, "--frontend", "scan_to_scan"});
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_NE(run.out.find("scan_to_scan"), std::string::npos) << run.out;
}

TEST(Plugin, WithoutItTheNameIsNotKnown) {
  const auto run = benchOf({"--frontend", "scan_to_scan"});
  EXPECT_EQ(run.exit_code, 2);
  EXPECT_NE(run.err.find("there is no front-end 'scan_to_scan'"), std::string::npos) << run.err;
}

TEST(Plugin, TwiceItsNameIsTaken) {
  const auto run = benchOf({"--plugin", PALOC_EXAMPLE_PLUGIN, "--plugin", PALOC_EXAMPLE_PLUGIN});
  EXPECT_EQ(run.exit_code, 2);
  EXPECT_NE(run.err.find("there is already a front-end"), std::string::npos) << run.err;
}

TEST(Plugin, WhatIsNoneIsToldInASentence) {
  const test::TempDir dir;
  std::ofstream(dir / "text.so") << "no library";
  const auto text = benchOf({"--plugin", (dir / "text.so").string()});
  EXPECT_EQ(text.exit_code, 3);
  EXPECT_NE(text.err.find("text.so"), std::string::npos) << text.err;
  const auto missing = benchOf({"--plugin", (dir / "missing.so").string()});
  EXPECT_EQ(missing.exit_code, 3);
  const auto other = benchOf({"--plugin", "libz.so.1"});
  EXPECT_EQ(other.exit_code, 2);
  EXPECT_NE(other.err.find("no plugin of paloc"), std::string::npos) << other.err;
}

}  // namespace
}  // namespace paloc

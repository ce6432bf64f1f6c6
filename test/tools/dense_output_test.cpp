#include "paloc/tools/dense_output.h"

#include <gtest/gtest.h>

#include <fstream>

#include "paloc/core/errors.h"
#include "temp_dir.h"

namespace paloc {
namespace {

std::filesystem::path fileWith(const test::TempDir& dir, const std::string& content) {
  const std::filesystem::path file = dir.path() / "stamps.txt";
  std::ofstream(file) << content;
  return file;
}

TEST(ReadStamps, TakesTheFirstFieldOfEachLineExactly) {
  const test::TempDir dir;
  const auto stamps = readStamps(
      fileWith(dir, "# camera\n1645002364.537699938\n\n1645002365.5 1 2 3 0 0 0 1\n 2.25,left\n"));
  EXPECT_EQ(stamps, (std::vector<TimeNs>{1645002364537699938, 1645002365500000000, 2250000000}));
}

TEST(ReadStamps, NamesFileAndLineOfWhatIsWrong) {
  const test::TempDir dir;
  const auto file = fileWith(dir, "1.5\nnoon\n");
  try {
    readStamps(file);
    FAIL() << "'noon' was taken for a time";
  } catch (const IoError& e) {
    EXPECT_NE(std::string(e.what()).find("stamps.txt:2: 'noon'"), std::string::npos) << e.what();
  }
  EXPECT_THROW(readStamps(fileWith(dir, "# nothing\n")), IoError);
  EXPECT_THROW(readStamps(dir.path() / "absent.txt"), IoError);
}

TEST(PosesAt, CountsInstantsWithoutAnAnswer) {
  std::vector<TrajectoryPoint> nodes(3);
  for (std::size_t k = 0; k < nodes.size(); ++k) nodes[k].t_ns = nsFromSeconds(0.1 * double(k));
  Result result;
  result.trajectory = nodes;
  const DenseTrajectory dense(result, ImuBuffer(), EstimatorSettings(), 0.5);
  const DensePoses poses = posesAt(
      dense, {nsFromSeconds(-0.1), nsFromSeconds(0.05), nsFromSeconds(0.2), nsFromSeconds(0.3)});
  EXPECT_EQ(poses.points.size(), 2u);
  EXPECT_EQ(poses.not_answered, 2u);
}

}  // namespace
}  // namespace paloc

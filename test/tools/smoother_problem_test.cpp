#include "paloc/tools/smoother_problem.h"

#include <gtest/gtest.h>

#include <fstream>

#include "paloc/core/errors.h"
#include "paloc/tools/bench_smoother.h"
#include "temp_dir.h"

namespace paloc {
namespace {

constexpr const char* kStart =
    "# a comment\n"
    "NOISE 0.001 0.0001 1e-5 1e-6\n"
    "STATE 0 0.0  0 0 0  0 0 0 1  1 0 0\n"
    "MAP 0  0 0 0  0 0 0 1  0.001 0.01\n"
    "IMU 0.0  0 0 9.81  0 0 0\n"
    "IMU 0.05  0 0 9.81  0 0 0   # at rest, but for gravity\n"
    "STATE 1 0.1  0.1 0 0  0 0 0 1  1 0 0\n";

class SmootherProblemFile : public testing::Test {
 protected:
  SmootherProblem read(const std::string& text) {
    std::ofstream(file_) << text;
    return readSmootherProblem(file_);
  }
  // The sentence that it is refused with.
  std::string refusal(const std::string& text) {
    try {
      read(text);
    } catch (const IoError& e) {
      return e.what();
    }
    return "accepted";
  }

  test::TempDir folder_;
  std::filesystem::path file_ = folder_.path() / "a.problem";
};

TEST_F(SmootherProblemFile, ReadsAllKindsOfLines) {
  const SmootherProblem p = read(std::string(kStart) +
                                 "ODOM 0 1  0.1 0 0  0 0 0 1  0.002 0.01\n"
                                 "MAPINFO 1  0.1 0 0  0 0 0.70710678 0.70710678 "
                                 " 1 0 0 0 0 0  4 0 0 0 0  9 0 0 0  16 0 0  25 0  36\n"
                                 "MAP 0  0 0 0.01  0 0 0 1  0.001 0.01\n");
  ASSERT_EQ(p.nodes.size(), 2u);
  EXPECT_EQ(p.noise.gyroscope_bias_walk_radps2_sqrthz, 1e-6);
  EXPECT_EQ(p.nodes[1].t_ns, 100'000'000);
  EXPECT_EQ(p.nodes[1].v_map_true, Vec3(1, 0, 0));
  ASSERT_EQ(p.nodes[1].imu.size(), 2u);
  EXPECT_EQ(p.nodes[1].imu[1].t_ns, 50'000'000);
  ASSERT_EQ(p.nodes[1].odometry.size(), 1u);
  EXPECT_NEAR(p.nodes[1].odometry[0].covariance(0, 0), 1e-4, 1e-15);
  EXPECT_NEAR(p.nodes[1].odometry[0].covariance(5, 5), 4e-6, 1e-15);
  ASSERT_EQ(p.nodes[1].map.size(), 2u);
  // Turned by 90 degrees, the body's x axis is the map's y.
  EXPECT_NEAR(p.nodes[1].map[0].information(0, 0), 4, 1e-6);
  EXPECT_NEAR(p.nodes[1].map[0].information(1, 1), 1, 1e-6);
  EXPECT_NEAR(p.nodes[1].map[0].information(5, 5), 36, 1e-6);
  EXPECT_EQ(p.nodes[1].map[1].node, 0u) << "late";
}

TEST_F(SmootherProblemFile, NamesWhatIsWrongByLine) {
  const std::string start = kStart;
  EXPECT_NE(refusal(start + "MAP 7  0 0 0  0 0 0 1  0.1 0.1\n").find(":8: no STATE"),
            std::string::npos);
  EXPECT_NE(refusal(start + "MAP 1  0 0 zero  0 0 0 1  0.1 0.1\n").find("field z is not"),
            std::string::npos);
  EXPECT_NE(refusal(start + "MAP 1  0 0 0  0 0 0 1  0.1\n").find("sigma_pos is missing"),
            std::string::npos);
  EXPECT_NE(refusal(start + "MAP 1  0 0 0  0 0 0 1  0 0.1\n").find("must be positive"),
            std::string::npos);
  EXPECT_NE(refusal(start + "MAP 1  0 0 0  0 0 0 2  0.1 0.1\n").find("quaternion"),
            std::string::npos);
  EXPECT_NE(refusal(start + "ODOM 0 1 0 0 0 0 0 0 1 1 1 1\n").find("more fields"),
            std::string::npos);
  EXPECT_NE(refusal(start + "ODOM 1 2 0 0 0 0 0 0 1 1 1\n").find("last STATE"), std::string::npos);
  EXPECT_NE(refusal(start + "STATE 3 0.2 0 0 0 0 0 0 1 0 0 0\n").find("count up"),
            std::string::npos);
  EXPECT_NE(refusal(start + "STATE 2 0.1 0 0 0 0 0 0 1 0 0 0\n").find("forwards"),
            std::string::npos);
  EXPECT_NE(refusal(start + "GPS 1 2 3\n").find("unknown kind"), std::string::npos);
  EXPECT_NE(refusal("NOISE 1 1 1 1\n").find("no STATE"), std::string::npos);
  EXPECT_NE(refusal("STATE 0 0 0 0 0 0 0 0 1 0 0 0\n").find("no NOISE"), std::string::npos);
  EXPECT_THROW(readSmootherProblem(folder_.path() / "missing"), IoError);
  EXPECT_THROW(readSmootherProblem(folder_.path()), IoError);
}

TEST_F(SmootherProblemFile, IsSmoothedOnlineAndAsABatch) {
  std::string text = kStart;
  for (int k = 2; k < 40; ++k) {
    const std::string x = std::to_string(0.1 * k);
    text += "IMU " + std::to_string(0.1 * (k - 1)) + " 0 0 9.81 0 0 0\n";
    text += "STATE " + std::to_string(k) + " " + x + " " + x + " 0 0 0 0 0 1 1 0 0\n";
    text += "MAP " + std::to_string(k) + " " + x + " 0 0 0 0 0 1 0.001 0.01\n";
  }
  BenchSmootherSettings settings;
  settings.lag_s = 1;
  const BenchSmootherResult r = benchSmoother(read(text), settings);
  EXPECT_EQ(r.nodes, 40u);
  EXPECT_EQ(r.newest.position_m.count, 40u);
  EXPECT_EQ(r.leaving.position_m.count, 29u);
  EXPECT_LT(r.newest.position_m.max, 1e-5);
  ASSERT_TRUE(r.batch.has_value());
  EXPECT_TRUE(r.batch_converged);
  EXPECT_LT(r.batch->position_m.max, 1e-5);
  EXPECT_EQ(r.trajectory.size(), 40u);
  EXPECT_EQ(r.repairs.total(), 0u);
  EXPECT_GT(r.update_ms.p50, 0);
}

}  // namespace
}  // namespace paloc

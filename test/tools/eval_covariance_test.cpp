#include "paloc/tools/eval_covariance.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "paloc/core/errors.h"
#include "paloc/core/mrpt_pose.h"
#include "paloc/tools/trajectory_csv.h"
#include "temp_dir.h"

namespace paloc {
namespace {

// Poses whose errors are drawn from their covariance, each tenth `factor` times as large; stamps
// differ from the truth's by 2 ms.
struct Drawn {
  std::vector<StampedPose> truth;
  std::vector<CovariantPose> estimate;
};

Drawn draw(int count, double factor_of_each_tenth) {
  std::mt19937 random(5);
  std::normal_distribution<double> normal;
  Eigen::Matrix<double, 6, 6> root;
  for (int k = 0; k < 36; ++k) root(k / 6, k % 6) = 0.01 * normal(random);
  Drawn drawn;
  for (int k = 0; k < count; ++k) {
    Vec6 unit;
    for (int i = 0; i < 6; ++i) unit[i] = normal(random);
    const TimeNs t_ns = 1'000'000'000'000 + k * 100'000'000LL;
    const Pose estimate{Vec3(k, 2, 3), so3::exp(Vec3(0.1, 0.01 * k, -0.2))};
    const bool tenth = k % 10 == 9;
    const Vec6 error = (tenth ? factor_of_each_tenth : 1.0) * (root * unit);
    drawn.truth.push_back({t_ns, boxplus(estimate, error)});
    CovariantPose row;
    row.pose = {t_ns + 2'000'000, estimate};
    row.covariance = root * root.transpose();
    row.flag = tenth ? "degenerate" : "good";
    drawn.estimate.push_back(row);
  }
  return drawn;
}

TEST(EvalCovariance, IsOneWhereErrorsAreDrawnFromTheCovariance) {
  const Drawn drawn = draw(20000, 3);
  const EvalCovarianceResult result = evaluateCovariance(drawn.truth, drawn.estimate, 0.01);
  ASSERT_EQ(result.by_flag.size(), 2u);
  const NormalizedErrors& good = result.by_flag.at("good");
  EXPECT_EQ(good.poses, 18000u);
  EXPECT_NEAR(good.pose, 1, 0.02);
  EXPECT_NEAR(good.position, 1, 0.03);
  EXPECT_NEAR(good.rotation, 1, 0.03);
  EXPECT_NEAR(good.outside_99, 0.01, 0.003);
  EXPECT_NEAR(good.position_rmse_m, good.position_sigma_m, 0.02 * good.position_sigma_m);
  EXPECT_NEAR(good.rotation_rmse_rad, good.rotation_sigma_rad, 0.02 * good.rotation_sigma_rad);
  const NormalizedErrors& weak = result.by_flag.at("degenerate");
  EXPECT_NEAR(weak.pose, 9, 0.5);
  EXPECT_GT(weak.outside_99, 0.5);
  EXPECT_NEAR(result.all.pose, 0.9 * good.pose + 0.1 * weak.pose, 1e-9);
}

TEST(EvalCovariance, CountsCovariancesThatAreNone) {
  Drawn drawn = draw(100, 1);
  drawn.estimate[3].covariance.setZero();
  drawn.estimate[4].covariance(2, 2) = std::nan("");
  const EvalCovarianceResult result = evaluateCovariance(drawn.truth, drawn.estimate, 0.01);
  EXPECT_EQ(result.unusable, 2u);
  EXPECT_EQ(result.all.poses, 98u);
}

TEST(EvalCovariance, SaysThatNothingBelongsTogether) {
  const Drawn drawn = draw(10, 1);
  EXPECT_THROW(evaluateCovariance(drawn.truth, drawn.estimate, 0.001), IoError);
}

TEST(TrajectoryCovariance, IsReadAsItIsWritten) {
  const test::TempDir dir;
  TrajectoryPoint point;
  point.t_ns = 1'700'000'000'123'456'789;
  point.T_map_body = toMrpt(Pose{Vec3(1, -2, 3), so3::exp(Vec3(0.3, -0.2, 2.5))});
  for (int k = 0; k < 36; ++k) point.covariance(k / 6, k % 6) = 1 + (k / 6) * (k % 6);
  point.flag = PoseFlag::kCoasting;
  test::writeFile(dir / "cov.csv", trajectoryCsv({point}));
  const std::vector<CovariantPose> rows = readTrajectoryCovariance(dir / "cov.csv");
  ASSERT_EQ(rows.size(), 1u);
  EXPECT_EQ(rows[0].pose.t_ns, point.t_ns);
  EXPECT_LT(boxminus(rows[0].pose.pose, fromMrpt(point.T_map_body)).norm(), 1e-6);
  EXPECT_EQ(rows[0].covariance, point.covariance);
  EXPECT_EQ(rows[0].flag, "coasting");
}

TEST(TrajectoryCovariance, NamesTheColumnThatIsWrong) {
  const test::TempDir dir;
  const auto sentenceOf = [&](const std::string& content) -> std::string {
    test::writeFile(dir / "cov.csv", content);
    try {
      readTrajectoryCovariance(dir / "cov.csv");
    } catch (const IoError& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_NE(sentenceOf("t_s,x_m\n1,2\n").find("there is no column 'y_m'"), std::string::npos);
  TrajectoryPoint point;
  std::string csv = trajectoryCsv({point});
  EXPECT_NE(sentenceOf(csv + "1,2\n").find("line 3: has 2 values"), std::string::npos);
  csv.replace(csv.find('\n') + 1, 1, "x");
  EXPECT_NE(sentenceOf(csv).find("(column 't_s')"), std::string::npos);
  EXPECT_NE(sentenceOf(trajectoryCsv({})).find("holds no pose"), std::string::npos);
}

}  // namespace
}  // namespace paloc

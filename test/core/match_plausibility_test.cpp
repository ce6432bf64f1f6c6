#include "paloc/core/match_plausibility.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>

#include "paloc/core/mrpt_pose.h"
#include "random_states.h"

namespace paloc {
namespace {

constexpr double kSigma = 0.005;  // m and rad, of matches and predictions

/// A walk along x whose prediction is right; matches as one wants them.
class Walk {
 public:
  bool judge(const Vec3& offset, double overlap = 0.9, double residual_m = 0.01) {
    predicted_.position.x() += 0.1;
    MapMatch match;
    match.refusal = MatchRefusal::kNone;
    match.T_map_body =
        toMrpt(Pose{predicted_.position + offset + random_.vector(kSigma), predicted_.rotation});
    match.information = Mat6::Identity() / (kSigma * kSigma);
    match.overlap = overlap;
    match.residual_median_m = residual_m;
    return plausibility_.believes(match, predicted_, sigma_ * sigma_ * Mat6::Identity());
  }
  // How many of `count` matches with this offset are believed.
  int believed(int count, const Vec3& offset, double overlap = 0.9, double residual_m = 0.01) {
    int sum = 0;
    for (int k = 0; k < count; ++k) sum += judge(offset, overlap, residual_m) ? 1 : 0;
    return sum;
  }
  void setSigma(double sigma) { sigma_ = sigma; }

 private:
  RandomStates random_{5};
  MatchPlausibility plausibility_{EstimatorSettings()};
  Pose predicted_;
  double sigma_ = kSigma;
};

TEST(MatchPlausibility, TheSquareIsMahalanobisAndKnowsNothingOfOpenDirections) {
  MapMatch match;
  match.T_map_body = toMrpt(Pose{Vec3(0.3, 0.02, 0), Mat3::Identity()});
  match.information = 1e4 * Mat6::Identity();
  match.information(0, 0) = 0;
  Mat6 covariance = 3e-4 * Mat6::Identity();
  const double floor = 0.005 * 0.005;
  EXPECT_NEAR(innovationSquare(match, Pose(), covariance), 4e-4 / (1e-4 + 3e-4 + floor), 1e-9);
}

TEST(MatchPlausibility, BelievesWhatIsUsual) {
  Walk walk;
  EXPECT_EQ(walk.believed(300, Vec3::Zero()), 300);
  EXPECT_EQ(walk.believed(50, Vec3::Zero(), 0.3, 0.03), 50) << "poor, but in the right place";
}

// Matches in the wrong place, with a map that lacks a part: they agree, but are not as good.
TEST(MatchPlausibility, PoorMatchesInTheWrongPlaceAreNeverBelieved) {
  Walk walk;
  ASSERT_EQ(walk.believed(60, Vec3::Zero()), 60);
  EXPECT_EQ(walk.believed(50, Vec3(0, 0.12, 0), 0.4, 0.01), 0);
  walk.setSigma(0.05);  // as the prediction becomes after a while
  EXPECT_EQ(walk.believed(50, Vec3(0, 0.12, 0), 0.4, 0.01), 0);
  EXPECT_EQ(walk.believed(20, Vec3(0, 0.06, 0)), 20) << "the map is right again";
}

// The same, entered slowly: a good part of the scan still matches, and the usual has become worse.
TEST(MatchPlausibility, MatchesThatHaveBecomeAFifthWorseAreNotBelievedForAgreeing) {
  Walk walk;
  ASSERT_EQ(walk.believed(60, Vec3::Zero(), 0.9), 60);
  ASSERT_EQ(walk.believed(10, Vec3::Zero(), 0.75), 10);
  walk.setSigma(0.02);
  EXPECT_EQ(walk.believed(100, Vec3(0.11, -0.12, 0), 0.72), 0);
}

// As good as ever, and of one mind: then it is the prediction that is wrong.
TEST(MatchPlausibility, GoodMatchesThatAgreeAreBelievedInTheEnd) {
  Walk walk;
  ASSERT_EQ(walk.believed(60, Vec3::Zero()), 60);
  const int wait = EstimatorSettings().believe_after_contradictions;
  EXPECT_EQ(walk.believed(wait, Vec3(0, 0.2, 0)), 0);
  EXPECT_EQ(walk.believed(30, Vec3(0, 0.2, 0)), 30);
}

TEST(MatchPlausibility, GoodMatchesThatJumpAboutAreNot) {
  Walk walk;
  ASSERT_EQ(walk.believed(60, Vec3::Zero()), 60);
  int believed = 0;
  for (int k = 0; k < 60; ++k) believed += walk.judge(Vec3(0, k % 2 ? 0.2 : -0.2, 0)) ? 1 : 0;
  EXPECT_EQ(believed, 0);
}

// Covariances that are five times too small are no reason to refuse everything.
TEST(MatchPlausibility, ContradictionIsRelativeToWhatIsUsual) {
  Walk walk;
  walk.setSigma(0.0001);
  RandomStates random(9);
  int believed = 0;
  for (int k = 0; k < 300; ++k) believed += walk.judge(random.vector(0.025)) ? 1 : 0;
  EXPECT_GT(believed, 290);
  EXPECT_EQ(walk.believed(5, Vec3(0, 0.5, 0)), 0);
}

}  // namespace
}  // namespace paloc

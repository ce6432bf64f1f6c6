#include "paloc/core/relocation.h"

#include <gtest/gtest.h>

#include "paloc/core/mrpt_pose.h"

namespace paloc {
namespace {

/// A map that finds a body where the test says, and remembers what it was asked.
class Finder : public MapMatcher {
 public:
  MapMatch match(const Scan&, const mrpt::poses::CPose3D&, double, double) override { return {}; }
  MapMatch locate(const Scan&, const StartGuess& guess) override {
    guesses.push_back(guess);
    MapMatch m;
    m.refusal = refusal;
    m.T_map_body = toMrpt(answer);
    return m;
  }

  Pose answer;
  MatchRefusal refusal = MatchRefusal::kNone;
  std::vector<StartGuess> guesses;
};

Mat6 covarianceOf(double sigma_m, double sigma_rad) {
  Vec6 variances;
  variances << Vec3::Constant(sigma_m * sigma_m), Vec3::Constant(sigma_rad * sigma_rad);
  return variances.asDiagonal();
}

/// Ten scans a second along x, 0.1 m apart; the body is really 7 m away from where it is expected.
struct Walk {
  EstimatorSettings settings;
  Relocation relocation{settings};
  Finder map;
  ExpectedPose expected;
  double step_m = 0.1;

  Walk() {
    expected.covariance = covarianceOf(10, 1);
    map.answer.position = Vec3(0, 7, 0);
  }
  MapMatch scan() {
    expected.t_ns += nsFromSeconds(0.1);
    expected.T_last_body = {Vec3(step_m, 0, 0), Mat3::Identity()};
    expected.T_map_body = expected.T_map_body * expected.T_last_body;
    map.answer.position.x() += step_m;
    return relocation.seek(map, Scan(), expected);
  }
  int scansUntilFound(int at_most = 100) {
    for (int k = 1; k <= at_most; ++k) {
      if (scan().accepted()) return k;
    }
    return 0;
  }
};

TEST(Relocation, IsLostBeyondTheReachOfRegistration) {
  EXPECT_FALSE(Relocation::lost(covarianceOf(0.3, 0.05)));
  EXPECT_TRUE(Relocation::lost(covarianceOf(0.4, 0.05)));
  EXPECT_TRUE(Relocation::lost(covarianceOf(0.3, 0.1)));
  EXPECT_TRUE(Relocation::lost(Mat6::Constant(std::numeric_limits<double>::quiet_NaN())));
}

TEST(Relocation, BelievesAPlaceThatTheNextScansBearOut) {
  Walk walk;
  const MapMatch first = walk.scan();
  EXPECT_EQ(first.refusal, MatchRefusal::kNotConfirmed);
  EXPECT_EQ(first.T_map_body.y(), 7) << "it is told where";
  EXPECT_EQ(walk.scansUntilFound(), walk.settings.start_confirmations);
}

TEST(Relocation, NeedsSomeWayBetweenTheScans) {
  Walk walk;
  walk.step_m = 0;
  EXPECT_EQ(walk.scansUntilFound(), 0) << "the same view says the same again";
  // Nor do steps to and fro, as of an odometry that trembles at rest.
  for (int k = 0; k < 100; ++k) {
    walk.step_m = k % 2 == 0 ? 0.02 : -0.02;
    EXPECT_FALSE(walk.scan().accepted()) << k;
  }
  walk.step_m = 0.1;
  EXPECT_GT(walk.scansUntilFound(), 0);
}

TEST(Relocation, DropsAPlaceThatTheNextScansDoNotBearOut) {
  Walk walk;
  walk.scan();
  walk.map.refusal = MatchRefusal::kLowOverlap;
  EXPECT_EQ(walk.scan().refusal, MatchRefusal::kLowOverlap);
  EXPECT_EQ(walk.scan().refusal, MatchRefusal::kLowOverlap);
  EXPECT_EQ(walk.scan().refusal, MatchRefusal::kNotTried) << "searched again a little later";
  walk.map.refusal = MatchRefusal::kNone;
  EXPECT_GT(walk.scansUntilFound(), walk.settings.start_confirmations);
}

TEST(Relocation, SearchesAgainAfterLongerAndLongerWaits) {
  Walk walk;
  walk.map.refusal = MatchRefusal::kNoPlaceFound;
  for (int k = 0; k < 320; ++k) walk.scan();
  // At 0, 2, 6 and 14 s, then at 30 s.
  EXPECT_EQ(walk.map.guesses.size(), 5u);
}

TEST(Relocation, SearchesNearWhereThatIsEnoughAndElseEverywhere) {
  Walk walk;
  walk.scan();
  EXPECT_FALSE(walk.map.guesses.back().T_map_body);
  EXPECT_FALSE(walk.map.guesses.back().up_body) << "unknown, too";

  Walk near;
  near.expected.covariance = covarianceOf(0.8, 0.05);
  near.expected.T_map_body.rotation = so3::exp(Vec3(0.1, 0, 0));
  near.scan();
  ASSERT_TRUE(near.map.guesses.back().T_map_body);
  EXPECT_TRUE(near.map.guesses.back().search_around);
  ASSERT_TRUE(near.map.guesses.back().up_body);
  EXPECT_LT((*near.map.guesses.back().up_body - so3::exp(Vec3(-0.1, 0, 0)) * Vec3::UnitZ()).norm(),
            1e-12);
}

}  // namespace
}  // namespace paloc

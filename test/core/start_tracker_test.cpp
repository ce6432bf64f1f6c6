#include "paloc/core/start_tracker.h"

#include <gtest/gtest.h>

#include "paloc/core/measured_up.h"
#include "paloc/core/mrpt_pose.h"

namespace paloc {
namespace {

constexpr TimeNs kFrame = kNsPerSecond / 10;

MapMatch answer(MatchRefusal refusal, bool searched) {
  MapMatch match;
  match.refusal = refusal;
  match.searched = searched;
  return match;
}

Pose at(double x) { return {Vec3(x, 0, 0), Mat3::Identity()}; }

StartGuess position() {
  StartGuess guess;
  guess.position_map = Vec3(1, 2, 3);
  return guess;
}

TEST(StartTracker, CarriesARoughPoseOnByTheOdometry) {
  StartTracker start({});
  StartGuess guess;
  guess.T_map_body = toMrpt(Pose{Vec3(5, 5, 0), so3::exp(Vec3(0, 0, M_PI / 2))});
  start.setGuess(guess);
  start.follow(at(10), false);
  start.follow(at(10.3), true);
  start.follow(at(99), false);  // a new stream: how far it is from the last one is not known
  start.follow(at(99.2), true);
  const auto now = start.guessAt(0, std::nullopt);
  ASSERT_TRUE(now && now->T_map_body);
  EXPECT_LT((fromMrpt(*now->T_map_body).position - Vec3(5, 5.5, 0)).norm(), 1e-9);
}

TEST(StartTracker, NothingIsTriedWithoutAGuess) {
  const StartTracker start({});
  EXPECT_FALSE(start.guessAt(0, std::nullopt));
  EXPECT_NE(start.reason().find("--init-pose"), std::string::npos);
}

TEST(StartTracker, SearchesAreTriedNowAndThenOnly) {
  StartTracker start({});
  start.setGuess({});
  start.follow(at(0), false);
  int tried = 0;
  for (int f = 0; f < 51; ++f) {
    const auto guess = start.guessAt(f * kFrame, std::nullopt);
    if (!guess) continue;
    ++tried;
    start.tried(f * kFrame, *guess, answer(MatchRefusal::kNoPlaceFound, true));
  }
  EXPECT_EQ(tried, 6);
  EXPECT_NE(start.reason().find("at each of 6 scans tried, the last time: fits nowhere"),
            std::string::npos);
}

TEST(StartTracker, RoughPoseIsTriedAtEveryScanAndSearchedNowAndThen) {
  StartTracker start({});
  StartGuess given;
  given.T_map_body = mrpt::poses::CPose3D();
  start.setGuess(given);
  start.follow(at(0), false);
  int tried = 0, searched = 0;
  for (int f = 0; f < 100; ++f) {
    const auto guess = start.guessAt(f * kFrame, Vec3(Vec3::UnitZ()));
    if (!guess) continue;
    ++tried;
    searched += guess->search_around;
    EXPECT_TRUE(guess->up_body);
    start.tried(f * kFrame, *guess, answer(MatchRefusal::kLowOverlap, false));
  }
  EXPECT_EQ(tried, EstimatorSettings().max_start_attempts);
  EXPECT_EQ(searched, 5);
}

TEST(StartTracker, PositionHoldsNearTheFirstFrameOnly) {
  StartTracker start({});
  start.setGuess(position());
  start.follow(at(0), false);
  EXPECT_TRUE(start.guessAt(0, std::nullopt));
  start.follow(at(0.6), true);
  EXPECT_FALSE(start.guessAt(0, std::nullopt));
}

TEST(StartTracker, StartByRegistrationIsBelievedAtOnce) {
  StartTracker start({});
  StartGuess guess;
  guess.T_map_body = mrpt::poses::CPose3D();
  start.setGuess(guess);
  start.tried(0, guess, answer(MatchRefusal::kNone, false));
  EXPECT_FALSE(start.pending());
}

TEST(StartTracker, StartBySearchIsBelievedAfterSomeScansAndSomeWay) {
  StartTracker start({});
  start.setGuess({});
  start.follow(at(0), false);
  start.tried(0, {}, answer(MatchRefusal::kNone, true));
  for (int f = 1; f <= 20; ++f) {
    EXPECT_TRUE(start.pending()) << f;
    EXPECT_TRUE(start.confirm(answer(MatchRefusal::kNone, false)));
    EXPECT_EQ(start.confirmedEnough(), f >= 5);
  }
  start.follow(at(0.6), true);
  EXPECT_TRUE(start.confirm(answer(MatchRefusal::kNone, false)));
  EXPECT_FALSE(start.pending());
  EXPECT_TRUE(start.confirm(answer(MatchRefusal::kLowOverlap, false))) << "no longer asked";
}

TEST(StartTracker, TwoScansAgainstItDropAPendingStart) {
  StartTracker start({});
  start.setGuess({});
  start.tried(0, {}, answer(MatchRefusal::kNone, true));
  EXPECT_TRUE(start.confirm(answer(MatchRefusal::kNone, false)));
  EXPECT_TRUE(start.confirm(answer(MatchRefusal::kNoScan, false))) << "says nothing";
  EXPECT_TRUE(start.confirm(answer(MatchRefusal::kLowOverlap, false)));
  EXPECT_FALSE(start.confirm(answer(MatchRefusal::kHighResidual, false)));
  start.drop();
  EXPECT_FALSE(start.pending());
  EXPECT_NE(start.reason().find("not confirmed"), std::string::npos);
  EXPECT_FALSE(start.guessAt(kFrame, std::nullopt)) << "not at once";
  EXPECT_TRUE(start.guessAt(20 * kFrame, std::nullopt));
}

TEST(StartTracker, FewScansAgainstManyDoNotDropAPendingStart) {
  StartTracker start({});
  start.setGuess({});
  start.tried(0, {}, answer(MatchRefusal::kNone, true));
  for (int f = 1; f <= 60; ++f) {
    const bool against = f % 20 == 0;
    EXPECT_TRUE(
        start.confirm(answer(against ? MatchRefusal::kNotConverged : MatchRefusal::kNone, false)));
  }
  EXPECT_TRUE(start.pending());
}

// A platform that turns at 30 degrees per second, tilted by 0.2 rad.
TEST(MeasuredUp, IsFeltWhileThePlatformTurns) {
  ImuBuffer imu;
  const Vec3 omega(0.3, 0.4, -0.1);
  const Mat3 R0 = so3::exp(Vec3(0.2, 0, 0));
  const auto rotation = [&](double t) { return Mat3(R0 * so3::exp(omega * t)); };
  for (int i = 0; i <= 400; ++i) {
    const double t = 0.005 * i;
    ImuSample sample;
    sample.t_ns = nsFromSeconds(t);
    sample.acc_body = rotation(t).transpose() * Vec3(0, 0, 9.81);
    sample.omega_body = omega;
    imu.add(sample);
  }
  const auto up = measuredUp(imu, nsFromSeconds(2), {});
  ASSERT_TRUE(up);
  EXPECT_LT((*up - rotation(2).transpose() * Vec3::UnitZ()).norm(), 1e-3);
  EXPECT_FALSE(measuredUp(ImuBuffer(), nsFromSeconds(2), {}));
}

}  // namespace
}  // namespace paloc

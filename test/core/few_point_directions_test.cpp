#include "paloc/core/few_point_directions.h"

#include <gtest/gtest.h>

#include "paloc/core/mrpt_pose.h"
#include "random_states.h"

namespace paloc {
namespace {

constexpr double kSigma = 0.006;  // m, of the weak direction

/// A walk through a corridor along (cos 30, sin 30, 0) with a head that turns; the odometry is
/// right, and the estimate off by what the test says.
class Walk {
 public:
  /// A scan whose `share` of points see the axis, `off` metres along it from the truth.
  MapMatch scan(double off, double share) {
    const Pose truth_before = truth_;
    truth_.position += 0.1 * axis_;
    truth_.rotation = truth_.rotation * so3::exp(Vec3(0.01, -0.02, 0.05));
    MapMatch match;
    match.refusal = MatchRefusal::kNone;
    match.T_map_body =
        toMrpt(Pose{truth_.position + (off + random_.normal(kSigma)) * axis_, truth_.rotation});
    match.information = Mat6::Identity() / (kSigma * kSigma);
    match.shared_spread = 0.1 * match.information;
    const Mat3 R_body_map = truth_.rotation.transpose();
    const Mat3 axes_map =
        (Mat3() << axis_, Vec3(-axis_.y(), axis_.x(), 0), Vec3::UnitZ()).finished();
    for (int i = 0; i < 6; ++i) {
      MatchDirection& direction = match.directions[static_cast<std::size_t>(i)];
      direction.axis_body = R_body_map * axes_map.col(i % 3);
      direction.cls = DirectionClass::kFull;
      direction.share = i == 0 ? share : 1;
      direction.sigma = kSigma;
    }
    directions_.check(displaced(truth_before), displaced(truth_), match);
    return match;
  }
  bool believed(double off, double share) {
    return scan(off, share).directions[0].cls == DirectionClass::kFull;
  }
  void forget() { directions_.forget(); }
  Vec3 axis() const { return axis_; }

 private:
  Pose displaced(const Pose& pose) const { return {pose.position + 0.2 * axis_, pose.rotation}; }

  RandomStates random_{3};
  Vec3 axis_ = Vec3(std::sqrt(0.75), 0.5, 0);
  Pose truth_{Vec3(4, -2, 1), so3::exp(Vec3(0.1, 0.05, 1))};
  FewPointDirections directions_;
};

TEST(FewPointDirections, CountFromTheFourthScanThatAgrees) {
  Walk walk;
  for (int k = 0; k < 3; ++k) EXPECT_FALSE(walk.believed(0, 0.01)) << k;
  for (int k = 3; k < 30; ++k) EXPECT_TRUE(walk.believed(0, 0.01)) << k;
}

TEST(FewPointDirections, ThatJumpAboutNeverCount) {
  Walk walk;
  const double wrong[] = {0.11, 0.19, 0.02, 0.07, 0.07, 0.15};
  for (int k = 0; k < 60; ++k) EXPECT_FALSE(walk.believed(wrong[k % 6], 0.01)) << k;
}

TEST(FewPointDirections, OneThatChangesItsMindStartsAgain) {
  Walk walk;
  for (int k = 0; k < 8; ++k) walk.scan(0.1, 0.01);
  EXPECT_TRUE(walk.believed(0.1, 0.01));
  for (int k = 0; k < 3; ++k) EXPECT_FALSE(walk.believed(0, 0.01)) << k;
  EXPECT_TRUE(walk.believed(0, 0.01));
}

TEST(FewPointDirections, ThatManyPointsKnewAMomentAgoGoOn) {
  Walk walk;
  EXPECT_TRUE(walk.believed(0, 0.2)) << "many points need no other scan";
  EXPECT_TRUE(walk.believed(0, 0.01));
  EXPECT_FALSE(walk.believed(0.1, 0.01)) << "somewhere else";
}

TEST(FewPointDirections, AScanThatSaysNothingBreaksTheRow) {
  Walk walk;
  for (int k = 0; k < 8; ++k) walk.scan(0, 0.01);
  walk.forget();
  EXPECT_FALSE(walk.believed(0, 0.01));
}

TEST(FewPointDirections, WithheldIsThatDirectionAndNothingElse) {
  Walk walk;
  const MapMatch match = walk.scan(0, 0.01);
  EXPECT_EQ(match.directions[0].cls, DirectionClass::kNone);
  EXPECT_EQ(match.directions[0].sigma, kUnknownSigma);
  Vec6 along = Vec6::Zero(), across = Vec6::Zero();
  along.head<3>() = walk.axis();
  across.head<3>() = Vec3(-walk.axis().y(), walk.axis().x(), 0);
  const double whole = 1 / (kSigma * kSigma);
  EXPECT_NEAR(along.dot(match.information * along), 0, 1e-9 * whole);
  EXPECT_NEAR(along.dot(match.shared_spread * along), 0, 1e-9 * whole);
  EXPECT_NEAR(across.dot(match.information * across), whole, 1e-9 * whole);
  EXPECT_NEAR(across.dot(match.shared_spread * across), 0.1 * whole, 1e-9 * whole);
  for (std::size_t i = 1; i < 6; ++i) {
    EXPECT_EQ(match.directions[i].cls, DirectionClass::kFull) << i;
  }
}

}  // namespace
}  // namespace paloc

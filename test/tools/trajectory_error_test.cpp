#include "paloc/tools/trajectory_error.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "paloc/core/errors.h"
#include "paloc/core/so3.h"
#include "paloc/tools/trajectory_alignment.h"
#include "paloc/tools/trajectory_coverage.h"

namespace paloc {
namespace {

constexpr TimeNs kStep = kNsPerSecond / 10;

Pose posed(double x, double y, double z, double yaw = 0) {
  return {Vec3(x, y, z), so3::exp(Vec3(0, 0, yaw))};
}

// A walk through space that turns: no symmetry that could hide an exchanged index or frame.
Pose walk(double t) {
  return {Vec3(std::cos(0.3 * t) * 5, 3 * std::sin(0.5 * t), 0.4 * t),
          so3::exp(Vec3(0.1 * std::sin(t), 0.2 * std::cos(0.7 * t), 0.5 * t))};
}

std::vector<StampedPose> walkAt(std::size_t poses) {
  std::vector<StampedPose> result;
  for (std::size_t i = 0; i < poses; ++i) {
    result.push_back({static_cast<TimeNs>(i) * kStep, walk(0.1 * static_cast<double>(i))});
  }
  return result;
}

std::vector<MatchedPose> matchedWalk(std::size_t poses, const Pose& T_estimate_reference) {
  std::vector<MatchedPose> result;
  for (const StampedPose& p : walkAt(poses)) {
    result.push_back({p.t_ns, p.pose, T_estimate_reference * p.pose});
  }
  return result;
}

TEST(InOrderOfTime, SortsAndCounts) {
  const OrderedTrajectory ordered = inOrderOfTime({{3, posed(3, 0, 0)},
                                                   {1, posed(1, 0, 0)},
                                                   {2, posed(2, 0, 0)},
                                                   {3, posed(9, 0, 0)},
                                                   {4, posed(4, 0, 0)}});
  ASSERT_EQ(ordered.poses.size(), 4U);
  EXPECT_EQ(ordered.out_of_order, 2U);
  EXPECT_EQ(ordered.duplicates, 1U);
  EXPECT_EQ(ordered.poses[2].pose.position.x(), 3);  // the first in the file, not the 9
  EXPECT_EQ(ordered.poses[3].t_ns, 4);
}

TEST(AssociateByTime, TakesTheNearestOneToOne) {
  const std::vector<StampedPose> longer{
      {0, posed(0, 0, 0)}, {100, posed(1, 0, 0)}, {200, posed(2, 0, 0)}, {300, posed(3, 0, 0)}};
  // 96 and 101 both want 100, and 101 is nearer; 220 gets 200.
  const std::vector<StampedPose> few{
      {96, posed(10, 0, 0)}, {101, posed(11, 0, 0)}, {220, posed(12, 0, 0)}};
  const Association a = associateByTime(longer, few, 25e-9);
  ASSERT_EQ(a.matched.size(), 2U);
  EXPECT_EQ(a.rivals, 1U);
  EXPECT_EQ(a.matched[0].t_ns, 100);
  EXPECT_EQ(a.matched[0].reference.position.x(), 1);
  EXPECT_EQ(a.matched[0].estimate.position.x(), 11);
  EXPECT_EQ(a.matched[1].estimate.position.x(), 12);
  EXPECT_DOUBLE_EQ(a.nearest_s, 1e-9);
  // The other way round: what is the estimate's stays the estimate's.
  const Association b = associateByTime(few, longer, 25e-9);
  ASSERT_EQ(b.matched.size(), 2U);
  EXPECT_EQ(b.matched[0].t_ns, 101);
  EXPECT_EQ(b.matched[0].reference.position.x(), 11);
  EXPECT_EQ(b.matched[0].estimate.position.x(), 1);
  EXPECT_EQ(associateByTime(longer, few, 10e-9).matched.size(), 1U);
  EXPECT_TRUE(associateByTime(longer, {{1000, {}}}, 25e-9).matched.empty());
}

TEST(Alignment, UndoesTheMotionThatWasMade) {
  const Pose moved{Vec3(3, -2, 0.7), so3::exp(Vec3(0.4, -0.3, 2.1))};
  const auto matched = matchedWalk(200, moved);
  for (const Alignment alignment : {Alignment::kSe3, Alignment::kOrigin}) {
    const Pose T = alignmentOf(matched, alignment);
    EXPECT_LT(boxminus(T * moved, Pose{}).norm(), 1e-12) << toString(alignment);
    const AbsoluteError error = absoluteError(aligned(matched, T));
    EXPECT_LT(error.translation_m.max, 1e-12);
    EXPECT_LT(error.rotation_rad.max, 1e-7);
  }
  EXPECT_LT(boxminus(alignmentOf(matched, Alignment::kNone), Pose{}).norm(), 1e-15);
}

TEST(Alignment, YawUndoesAYawAndNoTilt) {
  const Pose moved = posed(3, -2, 0.7, -2.8);
  EXPECT_LT(boxminus(alignmentOf(matchedWalk(200, moved), Alignment::kYaw) * moved, Pose{}).norm(),
            1e-12);
  const Pose tilted{Vec3(0, 0, 0), so3::exp(Vec3(0.05, 0, 0))};
  const Pose T = alignmentOf(matchedWalk(200, tilted), Alignment::kYaw);
  EXPECT_NEAR(T.rotation(2, 2), 1, 1e-15);
  EXPECT_GT(absoluteError(aligned(matchedWalk(200, tilted), T)).rotation_rad.rmse, 0.03);
}

TEST(Alignment, RefusesWhatPositionsDoNotFix) {
  std::vector<MatchedPose> line, lift;
  for (int i = 0; i < 10; ++i) {
    line.push_back({i * kStep, posed(i, 2.0 * i, 0), posed(i, 0, 0)});
    lift.push_back({i * kStep, posed(0, 0, i), posed(1, 1, i)});
  }
  EXPECT_THROW(alignmentOf(line, Alignment::kSe3), UsageError);
  EXPECT_NEAR(alignmentOf(line, Alignment::kYaw).rotation(1, 0), std::sin(std::atan(2.0)), 1e-12);
  EXPECT_THROW(alignmentOf(lift, Alignment::kYaw), UsageError);
  lift.resize(2);
  EXPECT_THROW(alignmentOf(lift, Alignment::kSe3), UsageError);
}

TEST(AbsoluteError, KnownErrors) {
  const AbsoluteError error = absoluteError({{0, posed(0, 0, 0), posed(3, 0, 0, 0.1)},
                                             {1, posed(1, 0, 0), posed(1, 4, 0, -0.3)},
                                             {2, posed(2, 0, 0), posed(2, 0, 5)},
                                             {3, posed(3, 0, 0), posed(3, 0, 0)}});
  const ErrorStatistics& t = error.translation_m;
  EXPECT_EQ(t.count, 4U);
  EXPECT_NEAR(t.rmse, std::sqrt(50.0 / 4), 1e-14);
  EXPECT_NEAR(t.mean, 3, 1e-14);
  EXPECT_NEAR(t.median, 3.5, 1e-14);
  EXPECT_NEAR(t.std, std::sqrt(14.0 / 4), 1e-14);
  EXPECT_NEAR(t.p95, 4.85, 1e-14);
  EXPECT_EQ(t.min, 0);
  EXPECT_EQ(t.max, 5);
  EXPECT_EQ(error.worst_ns, 2);
  EXPECT_NEAR(error.rotation_rad.max, 0.3, 1e-12);
  EXPECT_NEAR(error.rotation_rad.mean, 0.1, 1e-12);
  EXPECT_EQ(errorStatistics({}).count, 0U);
}

// Each step of the estimate is 1 cm and 2 mrad too long, along its own axes.
std::vector<MatchedPose> drifting(std::size_t poses) {
  const Pose step = posed(0.1, 0, 0, 0.02), wrong = posed(0.11, 0, 0, 0.022);
  std::vector<MatchedPose> matched{{0, walk(1), walk(2)}};
  while (matched.size() < poses) {
    const MatchedPose& last = matched.back();
    matched.push_back({last.t_ns + kStep, last.reference * step, last.estimate * wrong});
  }
  return matched;
}

TEST(RelativeError, SeesDriftPerStepInEachUnit) {
  const auto matched = drifting(101);
  RelativeErrorSettings settings;
  const RelativeError frame = relativeError(matched, settings);
  EXPECT_EQ(frame.translation_m.count, 100U);
  EXPECT_NEAR(frame.translation_m.rmse, 0.01, 1e-9);
  EXPECT_NEAR(frame.rotation_rad.max, 0.002, 1e-9);

  settings.delta = 10;
  const RelativeError frames = relativeError(matched, settings);
  EXPECT_EQ(frames.translation_m.count, 10U);
  EXPECT_NEAR(frames.rotation_rad.mean, 0.02, 1e-9);

  settings.delta = 1;
  settings.unit = DeltaUnit::kSeconds;
  const RelativeError seconds = relativeError(matched, settings);
  EXPECT_EQ(seconds.translation_m.count, 10U);
  EXPECT_NEAR(seconds.translation_m.rmse, frames.translation_m.rmse, 1e-12);

  settings.unit = DeltaUnit::kMetres;  // ten steps of 0.11 m; the first pair begins at the tenth
  const RelativeError metres = relativeError(matched, settings);
  EXPECT_EQ(metres.translation_m.count, 9U);
  EXPECT_NEAR(metres.rotation_rad.mean, 0.02, 1e-9);
}

TEST(RelativeError, NeverAcrossAGapUnlessAsked) {
  auto matched = drifting(101);
  matched.erase(matched.begin() + 50, matched.begin() + 60);  // 1.1 s between two poses
  matched.erase(matched.begin() + 20);                        // 0.2 s
  RelativeErrorSettings settings;
  const RelativeError without = relativeError(matched, settings);
  EXPECT_NEAR(without.max_gap_s, 0.15, 1e-12);
  EXPECT_EQ(without.pairs_across_gaps, 2U);
  EXPECT_EQ(without.translation_m.count, 87U);
  EXPECT_NEAR(without.translation_m.max, 0.01, 1e-9);
  settings.across_gaps = true;
  const RelativeError with = relativeError(matched, settings);
  EXPECT_EQ(with.pairs_across_gaps, 2U);
  EXPECT_EQ(with.translation_m.count, 89U);
  EXPECT_GT(with.translation_m.max, 0.1);

  settings.across_gaps = false;
  settings.unit = DeltaUnit::kSeconds;  // a pose that is missing inside a pair does it no harm
  const RelativeError seconds = relativeError(matched, settings);
  EXPECT_EQ(seconds.max_gap_s, 0.5);
  EXPECT_EQ(seconds.pairs_across_gaps, 1U);
  settings.max_gap_s = 0.15;
  EXPECT_EQ(relativeError(matched, settings).pairs_across_gaps, 2U);
}

TEST(RelativeError, SecondsEndAtTheNearestPose) {
  std::vector<MatchedPose> matched;
  for (const TimeNs ms : {0, 98, 203, 299, 401, 502, 599}) {
    matched.push_back({ms * 1'000'000, posed(0, 0, 0), posed(0, 0, 0)});
  }
  using Pairs = std::vector<std::pair<std::size_t, std::size_t>>;
  EXPECT_EQ(consecutivePairs(matched, 0.3, DeltaUnit::kSeconds), (Pairs{{0, 3}, {3, 6}}));
  EXPECT_EQ(consecutivePairs(matched, 0.001, DeltaUnit::kSeconds).size(), 6U);
  EXPECT_TRUE(consecutivePairs(matched, 1.0, DeltaUnit::kSeconds).empty());
  EXPECT_TRUE(consecutivePairs({}, 1.0, DeltaUnit::kSeconds).empty());
}

TEST(Coverage, CountsWhatTheReferenceHasAndTheEstimateLacks) {
  const auto reference = walkAt(101);
  const Coverage whole = coverageOf(reference, reference, 0, 0.01);
  EXPECT_EQ(whole.time_share, 1);
  EXPECT_EQ(whole.pose_share, 1);
  EXPECT_TRUE(whole.gaps.empty());

  auto estimate = reference;
  estimate.erase(estimate.begin() + 80, estimate.end());  // ends 2.1 s early
  estimate.erase(estimate.begin() + 40, estimate.begin() + 50);
  const Coverage part = coverageOf(reference, estimate, 0, 0.01);
  ASSERT_EQ(part.gaps.size(), 2U);
  EXPECT_EQ(part.gaps[0].reference_poses, 10U);
  EXPECT_NEAR(part.gaps[0].length_s(), 1.1, 1e-12);
  EXPECT_EQ(part.gaps[1].reference_poses, 21U);
  EXPECT_NEAR(part.time_share, 1 - 3.2 / 10, 1e-12);
  EXPECT_NEAR(part.pose_share, 1 - 31.0 / 101, 1e-12);
  // Nothing is missed of a reference that has the holes itself.
  EXPECT_EQ(coverageOf(estimate, reference, 0, 0.01).time_share, 1);
  EXPECT_EQ(coverageOf(estimate, estimate, 0, 0.01).time_share, 1);
}

}  // namespace
}  // namespace paloc

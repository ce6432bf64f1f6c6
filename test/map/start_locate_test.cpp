#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

#include "paloc/core/mrpt_pose.h"
#include "paloc/map/scan_level.h"
#include "paloc/map/scan_matcher.h"
#include "simulated_rooms.h"

namespace paloc {
namespace {

using test::furnishedRoom;
using test::sampleMap;
using test::simulateScan;

const Pose kBodyInWorld{Vec3(-0.5, -0.3, 1.4),
                        so3::exp(Vec3(0.06, -0.04, 0)) * so3::exp(Vec3(0, 0, 0.5))};

Pose truthIn(const test::BoxWorld& world) { return world.T_map_world * kBodyInWorld; }

Scan scanIn(const test::BoxWorld& world, unsigned seed = 5) {
  return simulateScan(world, truthIn(world), 20000, {0.02}, 30, seed);
}

std::shared_ptr<const PriorMap> mapOf(const test::BoxWorld& world) {
  return PriorMap::build(sampleMap(world, 0.06, 0.003, 1), {});
}

std::shared_ptr<const PriorMap> roomMap() {
  static const auto map = mapOf(furnishedRoom());
  return map;
}

StartGuess roughly(const Pose& truth, const Vec3& off_m, double yaw) {
  StartGuess guess;
  guess.T_map_body =
      toMrpt(Pose{truth.position + off_m, so3::exp(Vec3(0, 0, yaw)) * truth.rotation});
  return guess;
}

void expectFound(const MapMatch& match, const Pose& truth) {
  ASSERT_TRUE(match.accepted()) << toString(match.refusal) << ' ' << match.explained << ' '
                                << match.blocked << ' ' << match.runner_up;
  const Vec6 error = boxminus(fromMrpt(match.T_map_body), truth);
  EXPECT_LT(error.head<3>().norm(), 0.01);
  EXPECT_LT(error.tail<3>().norm(), 0.004);
}

TEST(StartLocate, FindsAScanFromThreeMetresAndFortyFiveDegrees) {
  const Pose truth = truthIn(furnishedRoom());
  const auto matcher = ScanMatcher::onto(roomMap(), {});
  for (const Vec3& off : {Vec3(3, 0, 0), Vec3(-2, -2, 0.5), Vec3(1, 2.5, -1), Vec3(0, -2, 2)}) {
    for (const double yaw : {0.78, -0.78}) {
      const MapMatch match = matcher->locate(scanIn(furnishedRoom()), roughly(truth, off, yaw));
      expectFound(match, truth);
      EXPECT_GT(match.explained, 0.9);
    }
  }
}

TEST(StartLocate, FindsAScanFromItsPositionAndFromNothing) {
  const Pose truth = truthIn(furnishedRoom());
  const auto matcher = ScanMatcher::onto(roomMap(), {});
  StartGuess guess;
  MapMatch match = matcher->locate(scanIn(furnishedRoom()), guess);
  expectFound(match, truth);
  EXPECT_TRUE(match.searched);
  guess.position_map = truth.position + Vec3(0.4, -0.3, 0.2);
  expectFound(matcher->locate(scanIn(furnishedRoom()), guess), truth);
  guess.up_body = truth.rotation.transpose() * Vec3::UnitZ();
  expectFound(matcher->locate(scanIn(furnishedRoom()), guess), truth);
  guess.position_map = truth.position + Vec3(0, 0, 20);
  EXPECT_FALSE(matcher->locate(scanIn(furnishedRoom()), guess).accepted());
}

TEST(StartLocate, BadPoseWithoutLeaveToSearchIsRefused) {
  StartGuess guess = roughly(truthIn(furnishedRoom()), Vec3(3, 0, 0), 0.78);
  guess.search_around = false;
  const auto matcher = ScanMatcher::onto(roomMap(), {});
  EXPECT_FALSE(matcher->locate(scanIn(furnishedRoom()), guess).accepted());
}

// Half a turn leaves a bare room as it is.
TEST(StartLocate, PlaceThatFitsTwiceIsAmbiguous) {
  test::BoxWorld bare = test::emptyRoom();
  bare.T_map_world = furnishedRoom().T_map_world;
  const auto matcher = ScanMatcher::onto(mapOf(bare), {});
  const MapMatch match = matcher->locate(scanIn(bare), {});
  EXPECT_EQ(match.refusal, MatchRefusal::kAmbiguous);
  EXPECT_GT(match.runner_up, 0.9);
  // What is known of the heading decides.
  expectFound(matcher->locate(scanIn(bare), roughly(truthIn(bare), Vec3(1, 1, 0), 0.5)),
              truthIn(bare));
}

TEST(StartLocate, CorridorWithoutEndsIsAmbiguous) {
  const test::BoxWorld world = test::corridor(0.3);
  const MapMatch match = ScanMatcher::onto(mapOf(world), {})->locate(scanIn(world), {});
  EXPECT_EQ(match.refusal, MatchRefusal::kAmbiguous) << toString(match.refusal);
}

test::BoxWorld mirrored(test::BoxWorld world) {
  for (test::Box& box : world.boxes) {
    const double low = box.low.y();
    box.low.y() = -box.high.y();
    box.high.y() = -low;
  }
  return world;
}

// The same room but for its furniture, which stands as in a mirror: several ways to lay it into the
// map are as good.
TEST(StartLocate, MirroredRoomIsRefused) {
  const auto matcher = ScanMatcher::onto(roomMap(), {});
  for (unsigned seed = 0; seed < 3; ++seed) {
    const MapMatch match = matcher->locate(scanIn(mirrored(furnishedRoom()), seed), {});
    EXPECT_FALSE(match.accepted()) << match.explained << ' ' << match.blocked;
  }
}

TEST(StartLocate, RoomOfAnotherSizeIsRefused) {
  test::BoxWorld longer = furnishedRoom(), higher = furnishedRoom();
  longer.boxes[0] = {Vec3(-7, -4, 0), Vec3(5, 6, 3)};
  higher.boxes[0] = {Vec3(-5, -4, 0), Vec3(5, 4, 4.5)};
  const auto matcher = ScanMatcher::onto(roomMap(), {});
  for (const test::BoxWorld& other : {longer, higher}) {
    for (const StartGuess& guess :
         {StartGuess{}, roughly(truthIn(furnishedRoom()), Vec3(0.5, 0, 0), 0.1),
          roughly(truthIn(furnishedRoom()), Vec3(2, -1, 0), 0.7)}) {
      const MapMatch match = matcher->locate(scanIn(other), guess);
      EXPECT_FALSE(match.accepted()) << match.explained << ' ' << match.blocked;
    }
  }
}

// The same walls, other furniture: another storey of the building, whose map was taken by mistake.
TEST(StartLocate, AnotherStoreyIsRefusedFromWhereTheRightOneWouldBe) {
  test::BoxWorld storey = test::emptyRoom();
  storey.T_map_world = furnishedRoom().T_map_world;
  storey.boxes.push_back({Vec3(-5, 1.5, 0), Vec3(-4.6, 3.2, 1.9)});
  storey.boxes.push_back({Vec3(0.2, -3.9, 0), Vec3(2.4, -2.8, 0.8)});
  storey.boxes.push_back({Vec3(4.5, 0.5, 0), Vec3(5, 2.5, 1.2)});
  const auto matcher = ScanMatcher::onto(roomMap(), {});
  for (const StartGuess& guess : {StartGuess{}, roughly(truthIn(storey), Vec3::Zero(), 0),
                                  roughly(truthIn(storey), Vec3(0.5, 0.3, 0), 0.1),
                                  roughly(truthIn(storey), Vec3(2, -1, 0), 0.7)}) {
    const MapMatch match = matcher->locate(scanIn(storey), guess);
    EXPECT_FALSE(match.accepted())
        << match.explained << ' ' << match.contradicted << ' ' << match.blocked;
  }
}

/// The furnished room with a screen, of which the survey did not see the side that faces the body.
test::BoxWorld roomWithScreen() {
  test::BoxWorld world = furnishedRoom();
  world.boxes.insert(world.boxes.begin() + 1, {Vec3(1.2, -1, 0), Vec3(1.5, 0.35, 1.4)});
  return world;
}

std::shared_ptr<const PriorMap> mapWithoutOneSideOfTheScreen() {
  const test::BoxWorld world = roomWithScreen();
  const test::Box& screen = world.boxes[1];
  const Pose T_world_map = world.T_map_world.inverse();
  PointCloud seen = sampleMap(world, 0.06, 0.003, 1);
  std::erase_if(seen.points, [&](const Point3f& p) {
    const Vec3 at = T_world_map * Vec3(static_cast<double>(p.x), static_cast<double>(p.y),
                                       static_cast<double>(p.z));
    return std::abs(at.x() - screen.low.x()) < 0.03 && at.y() > screen.low.y() + 0.03 &&
           at.y() < screen.high.y() - 0.03 && at.z() > 0.03 && at.z() < screen.high.z() - 0.03;
  });
  seen.intensity.clear();
  return PriorMap::build(seen, {});
}

TEST(StartLocate, SideThatTheSurveyDidNotSeeIsNoContradiction) {
  const test::BoxWorld world = roomWithScreen();
  const auto matcher = ScanMatcher::onto(mapWithoutOneSideOfTheScreen(), {});
  const MapMatch match =
      matcher->locate(scanIn(world), roughly(truthIn(world), Vec3(0.5, 0.3, 0), 0.1));
  EXPECT_GT(match.contradicted, 0.02);
  EXPECT_LT(match.blocked, 0.002);
  expectFound(match, truthIn(world));
}

// As many points off the map, but what the map shows elsewhere is not there.
TEST(StartLocate, SideThatTheSurveyDidNotSeeIsOneWhereSomethingIsGone) {
  test::BoxWorld scanned = roomWithScreen();
  const auto matcher = ScanMatcher::onto(mapWithoutOneSideOfTheScreen(), {});
  scanned.boxes.pop_back();
  const MapMatch match =
      matcher->locate(scanIn(scanned), roughly(truthIn(scanned), Vec3(0.5, 0.3, 0), 0.1));
  EXPECT_GT(match.blocked, 0.004);
  EXPECT_EQ(match.refusal, MatchRefusal::kMapContradicts) << match.contradicted;
}

// What lies beyond the part that was surveyed says nothing against a place. (Without a pose so near
// half of a box is ambiguous: moved and turned, as much of it lies beyond, and little contradicts.)
TEST(StartLocate, FindsAScanInAMapThatLacksHalfOfTheRoom) {
  const test::BoxWorld world = furnishedRoom();
  const Pose truth = truthIn(world), T_world_map = world.T_map_world.inverse();
  PointCloud half = sampleMap(world, 0.06, 0.003, 1);
  std::erase_if(half.points, [&](const Point3f& p) {
    const Vec3 at(static_cast<double>(p.x), static_cast<double>(p.y), static_cast<double>(p.z));
    return (T_world_map * at).x() > -0.3;
  });
  half.intensity.clear();
  const auto matcher = ScanMatcher::onto(PriorMap::build(half, {}), {});
  for (const StartGuess& guess :
       {roughly(truth, Vec3(0.5, 0.3, 0), 0.1), roughly(truth, Vec3(-0.4, 0.6, 0.1), -0.15)}) {
    const MapMatch match = matcher->locate(scanIn(world), guess);
    ASSERT_TRUE(match.accepted()) << toString(match.refusal) << ' ' << match.explained << ' '
                                  << match.contradicted << ' ' << match.blocked << ' '
                                  << match.runner_up << ' ' << match.searched;
    EXPECT_LT(match.explained, 0.65);
    const Vec6 error = boxminus(fromMrpt(match.T_map_body), truth);
    EXPECT_LT(error.head<3>().norm(), 0.015);
    EXPECT_LT(error.tail<3>().norm(), 0.004);
  }
}

TEST(StartLocate, SameBytesOnOneThreadAndTwo) {
  const auto locate = [&](int threads) {
    MatcherSettings settings;
    settings.threads = threads;
    return ScanMatcher::onto(roomMap(), settings)->locate(scanIn(furnishedRoom()), {});
  };
  const MapMatch one = locate(1), two = locate(2);
  const Pose a = fromMrpt(one.T_map_body), b = fromMrpt(two.T_map_body);
  EXPECT_EQ(std::memcmp(a.position.data(), b.position.data(), sizeof(Vec3)), 0);
  EXPECT_EQ(std::memcmp(a.rotation.data(), b.rotation.data(), sizeof(Mat3)), 0);
  EXPECT_EQ(one.explained, two.explained);
  EXPECT_EQ(one.runner_up, two.runner_up);
}

TEST(StartLocate, ScanTooSmallIsRefused) {
  const auto matcher = ScanMatcher::onto(roomMap(), {});
  EXPECT_EQ(matcher->locate({}, {}).refusal, MatchRefusal::kNoScan);
  Scan few = scanIn(furnishedRoom());
  few.points_body.resize(20);
  EXPECT_EQ(matcher->locate(few, {}).refusal, MatchRefusal::kTooFewPoints);
}

TEST(ScanLevel, IsToldByFloorAndWalls) {
  for (const Vec3& tilt : {Vec3(0.15, 0, 0), Vec3(-0.1, 0.12, 0), Vec3(0, -0.2, 0)}) {
    const test::BoxWorld room = furnishedRoom();
    const Pose pose = room.T_map_world * Pose{Vec3(0, 0, 1.4), so3::exp(tilt)};
    const auto up =
        levelOfScan(simulateScan(room, pose, 20000, {0.02}, 30, 2).points_body, Vec3::UnitZ());
    ASSERT_TRUE(up);
    const Vec3 truth = so3::exp(-tilt) * Vec3::UnitZ();
    EXPECT_LT(std::acos(std::min(1.0, up->dot(truth))), 0.01) << tilt.transpose();
  }
  EXPECT_FALSE(levelOfScan({{1, 2, 3}, {4, 5, 6}}, Vec3::UnitZ()));
}

}  // namespace
}  // namespace paloc

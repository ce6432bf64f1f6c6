#include "paloc/map/occupancy_map.h"

#include <gtest/gtest.h>
#include <octomap/OcTree.h>

#include "paloc/core/errors.h"
#include "paloc/map/octree_map.h"
#include "ray_scans.h"
#include "temp_dir.h"

namespace paloc {
namespace {

using State = OccupancyMap::State;

/// One ray from a place to another.
ScanRays ray(const Vec3& from, const Vec3& to) {
  return {0, {test::toPoint(from)}, {test::toPoint(to)}, 0, 0};
}

TEST(OccupancyMap, IsFreeAlongARayAndOccupiedAtItsEnd) {
  OccupancyMap map({}, Vec3::Zero());
  map.insert(ray({0.05, 0.05, 0.05}, {2.05, 0.05, 0.05}));
  EXPECT_EQ(map.at({0.05, 0.05, 0.05}), State::kFree);
  EXPECT_EQ(map.at({1.05, 0.05, 0.05}), State::kFree);
  EXPECT_EQ(map.at({1.95, 0.05, 0.05}), State::kFree);
  EXPECT_EQ(map.at({2.05, 0.05, 0.05}), State::kOccupied);
  EXPECT_EQ(map.at({2.15, 0.05, 0.05}), State::kUnknown);
  EXPECT_EQ(map.at({1.05, 0.25, 0.05}), State::kUnknown);
  EXPECT_EQ(map.scans(), 1U);
}

TEST(OccupancyMap, ALongRayTellsOfFreeSpaceOnly) {
  OccupancySettings settings;
  settings.max_range_m = 3;
  OccupancyMap map(settings, Vec3::Zero());
  map.insert(ray({0.05, 0.05, 0.05}, {5.05, 0.05, 0.05}));
  EXPECT_EQ(map.at({2.95, 0.05, 0.05}), State::kFree);
  EXPECT_EQ(map.at({4.05, 0.05, 0.05}), State::kUnknown);
  EXPECT_EQ(map.at({5.05, 0.05, 0.05}), State::kUnknown);
}

TEST(OccupancyMap, AWallGrazedByRaysOfItsOwnScanStays) {
  const test::BoxWorld room = test::emptyRoom();
  OccupancyMap map({}, Vec3::Zero());
  // Close to the wall at x = 5, so that many rays run along it.
  for (unsigned i = 0; i < 12; ++i) {
    map.insert(test::raysOf(room, {Vec3(4.5, -3 + 0.5 * i, 1.5), Mat3::Identity()}, i, i + 1));
  }
  int occupied = 0, all = 0;
  for (double y = -2.95; y < 3; y += 0.1) {
    for (double z = 0.55; z < 2.5; z += 0.1) {
      ++all;
      // The wall lies on the border of two cells.
      occupied +=
          map.at({4.95, y, z}) == State::kOccupied || map.at({5.05, y, z}) == State::kOccupied;
      EXPECT_NE(map.at({4.5, y, z}), State::kOccupied);
    }
  }
  EXPECT_GT(occupied, all * 9 / 10);
}

TEST(OccupancyMap, WhatHasGoneBecomesFree) {
  OccupancyMap map({}, Vec3::Zero());
  map.insert(ray({0.05, 0.05, 0.05}, {1.05, 0.05, 0.05}));
  EXPECT_EQ(map.at({1.05, 0.05, 0.05}), State::kOccupied);
  for (int i = 0; i < 4; ++i) map.insert(ray({0.05, 0.05, 0.05}, {2.05, 0.05, 0.05}));
  EXPECT_EQ(map.at({1.05, 0.05, 0.05}), State::kFree);
}

TEST(OccupancyMap, TheFileIsReadByOurReaderAndByTheLibrary) {
  const test::TempDir dir;
  OccupancyMap map({}, Vec3::Zero());
  const test::BoxWorld room = test::emptyRoom();
  for (unsigned i = 0; i < 3; ++i) {
    map.insert(test::raysOf(room, {Vec3(0, i, 1.5), Mat3::Identity()}, i, i + 1));
  }
  map.save(dir / "octomap.bt");
  const OctreeMap ours = OctreeMap::load(dir / "octomap.bt");
  octomap::OcTree theirs((dir / "octomap.bt").string());
  EXPECT_DOUBLE_EQ(ours.resolution(), 0.1);
  EXPECT_DOUBLE_EQ(theirs.getResolution(), 0.1);
  int occupied = 0, free = 0;
  for (double x = -5.15; x < 5.2; x += 0.1) {
    for (double y = -4.15; y < 4.2; y += 0.1) {
      const Vec3 p(x, y, 1.55);
      const octomap::OcTreeNode* node = theirs.search(x, y, 1.55);
      const State read = node == nullptr               ? State::kUnknown
                         : theirs.isNodeOccupied(node) ? State::kOccupied
                                                       : State::kFree;
      ASSERT_EQ(read, map.at(p));
      ASSERT_EQ(ours.at(p) == OctreeMap::State::kOccupied, read == State::kOccupied);
      ASSERT_EQ(ours.at(p) == OctreeMap::State::kFree, read == State::kFree);
      occupied += read == State::kOccupied;
      free += read == State::kFree;
    }
  }
  EXPECT_GT(occupied, 150);
  EXPECT_GT(free, 5000);
}

TEST(OccupancyMap, FarFromZeroTheTreeHasAnOriginOfItsOwn) {
  const test::TempDir dir;
  const Vec3 utm(412345.6, 5654321.7, 312.4);
  OccupancyMap map({}, utm);
  map.insert(ray({0, 0, 0}, {2, 0, 0}));
  EXPECT_LT((map.origin() - utm).cwiseAbs().maxCoeff(), 5.01);
  EXPECT_EQ(map.at(utm + Vec3(1, 0, 0)), State::kFree);
  EXPECT_EQ(map.at(utm + Vec3(2, 0, 0)), State::kOccupied);
  map.save(dir / "octomap.bt");
  const std::string header = test::readFile(dir / "octomap.bt").substr(0, 300);
  EXPECT_NE(header.find("add (412350, 5654320, 310) m"), std::string::npos) << header;
  EXPECT_EQ(OctreeMap::load(dir / "octomap.bt").at(Vec3(utm + Vec3(2, 0, 0) - map.origin())),
            OctreeMap::State::kOccupied);
  EXPECT_TRUE(OccupancyMap({}, Vec3(1200, -900, 30)).origin().isZero(0));
}

TEST(OccupancyMap, LeavesOutWhatItHasNoRoomFor) {
  OccupancySettings settings;
  settings.max_memory_mb = 1;
  OccupancyMap map(settings, Vec3::Zero());
  const test::BoxWorld room = test::emptyRoom();
  const ScanRays scan = test::raysOf(room, {Vec3(0, 0, 1.5), Mat3::Identity()}, 0, 1);
  EXPECT_TRUE(map.insert(scan));
  EXPECT_GT(map.memoryMb(), 1);
  EXPECT_FALSE(map.insert(scan));
  EXPECT_EQ(map.scans(), 1U);

  OccupancyMap small({}, Vec3::Zero());
  small.insert(ray({3270, 0, 0}, {3290, 0, 0}));  // 2^15 cells of 0.1 m reach 3276.8 m
  EXPECT_EQ(small.raysOutside(), 1U);
}

TEST(OccupancyMap, TellsThatAFileCannotBeWritten) {
  OccupancyMap map({}, Vec3::Zero());
  map.insert(ray({0, 0, 0}, {1, 0, 0}));
  EXPECT_THROW(map.save("/nowhere/octomap.bt"), IoError);
}

}  // namespace
}  // namespace paloc

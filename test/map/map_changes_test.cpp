#include "paloc/map/map_changes.h"

#include <gtest/gtest.h>

#include "paloc/core/errors.h"
#include "ray_scans.h"
#include "temp_dir.h"

namespace paloc {
namespace {

using test::Box;
using test::BoxWorld;

const Box kTable{Vec3(1.2, 1.1, 0), Vec3(2.8, 2.3, 0.8)};
const Box kCupboard{Vec3(-5, -4, 0), Vec3(-4.2, -1.5, 1.9)};
const Vec3 kFrom(-3, -1, 1.4), kTo(3, -1, 1.4);
constexpr int kScans = 24;

BoxWorld roomWith(std::vector<Box> boxes) {
  BoxWorld world = test::emptyRoom();
  for (const Box& box : boxes) world.boxes.push_back(box);
  return world;
}

std::shared_ptr<const PriorMap> mapOf(const BoxWorld& world) {
  return PriorMap::build(test::sampleMap(world, 0.05, 0.003, 1), {});
}

MapChanges changesOf(const BoxWorld& map, const ScanRaySource& scans, int threads = 1,
                     const ChangeSettings& settings = {}) {
  return findChanges(*mapOf(map), scans, Vec3::UnitZ(), settings, {0.01, 0.005}, threads);
}

bool isIn(const Box& box, const Point3f& p, double margin_m) {
  const Vec3 v(static_cast<double>(p.x), static_cast<double>(p.y), static_cast<double>(p.z));
  return ((v - box.low).array() >= -margin_m).all() && ((v - box.high).array() <= margin_m).all();
}

std::size_t countIn(const MapChanges& changes, MapChange kind, const Box& box) {
  std::size_t inside = 0;
  for (std::size_t i = 0; i < changes.kinds.size(); ++i) {
    inside += changes.kinds[i] == kind && isIn(box, changes.cloud.points[i], 0.06);
  }
  return inside;
}

TEST(MapChanges, NothingChanged) {
  const BoxWorld room = roomWith({kTable, kCupboard});
  const MapChanges changes = changesOf(room, test::walkThrough(room, kFrom, kTo, kScans));
  EXPECT_EQ(changes.count(MapChange::kGone), 0U);
  EXPECT_EQ(changes.count(MapChange::kAdded), 0U);
  EXPECT_EQ(changes.count(MapChange::kMoved), 0U);
  EXPECT_EQ(changes.scans_used, static_cast<std::size_t>(kScans));
  EXPECT_GT(changes.map_points_seen, 20'000U);
}

TEST(MapChanges, ATableThatWasTakenAwayIsGone) {
  const MapChanges changes = changesOf(
      roomWith({kTable, kCupboard}), test::walkThrough(roomWith({kCupboard}), kFrom, kTo, kScans));
  // Its top and the two sides that are seen have some 2,500 points.
  EXPECT_GT(countIn(changes, MapChange::kGone, kTable), 1200U);
  EXPECT_EQ(changes.count(MapChange::kGone), countIn(changes, MapChange::kGone, kTable));
  EXPECT_EQ(changes.count(MapChange::kMoved), 0U);
}

TEST(MapChanges, ABoxThatWasPutThereIsAdded) {
  const Box box{Vec3(0.5, 0.6, 0), Vec3(1.1, 1.2, 1)};
  const MapChanges changes = changesOf(
      roomWith({kCupboard}), test::walkThrough(roomWith({kCupboard, box}), kFrom, kTo, kScans));
  EXPECT_GT(countIn(changes, MapChange::kAdded, box), 200U);
  EXPECT_EQ(changes.count(MapChange::kAdded), countIn(changes, MapChange::kAdded, box));
  EXPECT_EQ(changes.count(MapChange::kGone), 0U);
  EXPECT_EQ(changes.count(MapChange::kMoved), 0U);
}

TEST(MapChanges, APersonWhoWalksByHasMoved) {
  const BoxWorld room = roomWith({kCupboard});
  test::RayScans scans;
  for (int i = 0; i < kScans; ++i) {
    const double y = -2 + 0.2 * i;
    BoxWorld now = room;
    now.boxes.push_back({Vec3(1.0, y, 0), Vec3(1.4, y + 0.4, 1.7)});
    scans.add(test::raysOf(now, {Vec3(-1, 0, 1.4), Mat3::Identity()}, i * kNsPerSecond / 2,
                           static_cast<unsigned>(i + 1)));
  }
  const MapChanges changes = changesOf(room, scans);
  const Box swept{Vec3(1.0, -2, 0), Vec3(1.4, 3.0, 1.7)};
  EXPECT_GT(countIn(changes, MapChange::kMoved, swept), 500U);
  EXPECT_EQ(changes.count(MapChange::kMoved), countIn(changes, MapChange::kMoved, swept));
  EXPECT_EQ(changes.count(MapChange::kGone), 0U);
}

TEST(MapChanges, WhatIsHiddenIsNotGone) {
  // The cupboard stands behind a new partition: no ray reaches it.
  const Box partition{Vec3(-4, -4, 0), Vec3(-3.9, 4, 3)};
  const MapChanges changes =
      changesOf(roomWith({kTable, kCupboard}),
                test::walkThrough(roomWith({kTable, kCupboard, partition}), kFrom, kTo, kScans));
  EXPECT_EQ(changes.count(MapChange::kGone), 0U);
  EXPECT_GT(countIn(changes, MapChange::kAdded, partition), 1000U);
}

TEST(MapChanges, ASurfaceThatIsOnlyGrazedStays) {
  // From just above the table's top, all rays that cross it are flat.
  const BoxWorld map = roomWith({kTable});
  const auto grazing = [&](float too_low_m) {
    test::RayScans scans;
    for (int i = 0; i < kScans; ++i) {
      const Vec3 at(-2 + 0.1 * i, 1.7, 0.85);
      scans.add(test::raysOf(map, {at, Mat3::Identity()}, i * kNsPerSecond / 2,
                             static_cast<unsigned>(i + 1)));
      for (Point3f& p : scans.back().from) p.z -= too_low_m;
      for (Point3f& p : scans.back().to) p.z -= too_low_m;
      scans.back().position_sigma_m = 0.005;
    }
    return scans;
  };
  // All of the top but its far rim: the face below that is hidden, and rays come within 4 cm of it.
  const Box top{Vec3(1.2, 1.1, 0.8), Vec3(2.7, 2.3, 0.8)};
  EXPECT_EQ(countIn(changesOf(map, grazing(0.01F)), MapChange::kGone, top), 0U);

  // Without regard to grazing and noise, poses that are 4 cm too low cut off the top.
  ChangeSettings careless;
  careless.min_incidence_cos = 0.01;
  careless.clear_m = 0;
  careless.min_dominance = 1;
  const MapChanges cut =
      findChanges(*mapOf(map), grazing(0.04F), Vec3::UnitZ(), careless, {0, 0}, 1);
  EXPECT_GT(countIn(cut, MapChange::kGone, top), 10U);
}

TEST(MapChanges, AWallBehindGlassStays) {
  // A pane before the wall at x = 5 mirrors a third of the rays: they seem to end far behind it.
  const BoxWorld room = roomWith({kTable});
  test::RayScans scans = test::walkThrough(room, kFrom, kTo, kScans);
  test::RayScans mirrored;
  for (std::size_t i = 0; i < scans.size(); ++i) {
    ScanRays rays = scans.rays(i);
    for (std::size_t k = 0; k < rays.to.size(); k += 3) {
      Point3f& to = rays.to[k];
      const Point3f& from = rays.from[k];
      if (to.x < 4.9F) continue;
      to = {to.x + (to.x - from.x), to.y + (to.y - from.y), to.z + (to.z - from.z)};
    }
    mirrored.add(std::move(rays));
  }
  EXPECT_EQ(changesOf(room, mirrored).count(MapChange::kGone), 0U);
}

TEST(MapChanges, BeyondTheMapIsUnmapped) {
  // The map ends at x = 0: of what lies beyond it has neither walls nor floor.
  const BoxWorld room = roomWith({});
  PointCloud half = test::sampleMap(room, 0.05, 0.003, 1);
  std::erase_if(half.points, [](const Point3f& p) { return p.x > 0; });
  const auto map = PriorMap::build(half, {});
  const MapChanges changes =
      findChanges(*map, test::walkThrough(room, Vec3(-3, -1, 1.4), Vec3(1, -1, 1.4), kScans),
                  Vec3::UnitZ(), {}, {0.01, 0.005}, 1);
  EXPECT_GT(changes.count(MapChange::kUnmapped), 3000U);
  EXPECT_EQ(changes.count(MapChange::kAdded), 0U);
  EXPECT_EQ(changes.count(MapChange::kGone), 0U);
}

TEST(MapChanges, ScansOfUnsurePosesAreNotUsed) {
  test::RayScans scans;
  for (int i = 0; i < kScans; ++i) {
    scans.add(test::raysOf(roomWith({}), {Vec3(0, 0, 1.4), Mat3::Identity()}, i * kNsPerSecond,
                           static_cast<unsigned>(i + 1)));
    scans.back().position_sigma_m = 0.2;
  }
  const MapChanges changes = changesOf(roomWith({kTable}), scans);
  EXPECT_EQ(changes.scans_unsure, static_cast<std::size_t>(kScans));
  EXPECT_EQ(changes.scans_used, 0U);
  EXPECT_EQ(changes.map_points_seen, 0U);
  EXPECT_TRUE(changes.kinds.empty());
}

TEST(MapChanges, TooFewScansTellNothing) {
  const auto scans = test::walkThrough(roomWith({}), kFrom, kTo, 5);
  ChangeSettings settings;
  settings.min_scans = 6;
  EXPECT_TRUE(changesOf(roomWith({kTable}), scans, 1, settings).kinds.empty());
  settings.min_scans = 3;
  EXPECT_GT(changesOf(roomWith({kTable}), scans, 1, settings).count(MapChange::kGone), 100U);
}

TEST(MapChanges, TheSameOnAnyNumberOfThreads) {
  const BoxWorld map = roomWith({kTable, kCupboard});
  const auto scans = test::walkThrough(
      roomWith({kCupboard, {Vec3(0.5, 0.6, 0), Vec3(1.1, 1.2, 1)}}), kFrom, kTo, kScans);
  const test::TempDir dir;
  saveChanges(dir / "1.ply", changesOf(map, scans, 1));
  saveChanges(dir / "2.ply", changesOf(map, scans, 2));
  EXPECT_GT(test::readFile(dir / "1.ply").size(), 10'000U);
  EXPECT_EQ(test::readFile(dir / "1.ply"), test::readFile(dir / "2.ply"));
}

MapChanges fewChanges(const Vec3& origin) {
  MapChanges changes;
  changes.cloud.origin = origin;
  for (const MapChange kind : kAllMapChanges) {
    const float at = static_cast<float>(kind);
    changes.cloud.points.push_back({at, 2 * at, -at});
    changes.kinds.push_back(kind);
  }
  return changes;
}

TEST(MapChangesFile, NamesItsClassesAndReadsBack) {
  const test::TempDir dir;
  for (const Vec3& origin : {Vec3(0, 0, 0), Vec3(412345.25, 5654321.5, 312)}) {
    const MapChanges changes = fewChanges(origin);
    saveChanges(dir / "changes.ply", changes);
    const std::string header = test::readFile(dir / "changes.ply").substr(0, 500);
    for (const char* line :
         {"comment change 1 gone\n", "comment change 2 added\n", "comment change 3 moved\n",
          "comment change 4 unmapped\n", "property uchar change\n", "property uchar red\n"}) {
      EXPECT_NE(header.find(line), std::string::npos) << line;
    }
    const MapChanges back = loadChanges(dir / "changes.ply");
    EXPECT_EQ(back.kinds, changes.kinds);
    ASSERT_EQ(back.cloud.size(), changes.cloud.size());
    for (std::size_t i = 0; i < back.cloud.size(); ++i) {
      const Point3f &p = changes.cloud.points[i], &q = back.cloud.points[i];
      EXPECT_NEAR(origin.x() + static_cast<double>(p.x),
                  back.cloud.origin.x() + static_cast<double>(q.x), 1e-6);
      EXPECT_NEAR(origin.z() + static_cast<double>(p.z),
                  back.cloud.origin.z() + static_cast<double>(q.z), 1e-6);
    }
  }
}

TEST(MapChangesFile, DamagedFilesAreRefused) {
  const test::TempDir dir;
  saveChanges(dir / "changes.ply", fewChanges(Vec3::Zero()));
  const std::string whole = test::readFile(dir / "changes.ply");
  test::writeFile(dir / "cut.ply", whole.substr(0, whole.size() - 3));
  EXPECT_THROW(loadChanges(dir / "cut.ply"), IoError);
  test::writeFile(dir / "text.ply", "ply\nformat ascii 1.0\nend_header\n");
  EXPECT_THROW(loadChanges(dir / "text.ply"), IoError);
  std::string unknown = whole;
  unknown[unknown.size() - 4] = 9;
  test::writeFile(dir / "unknown.ply", unknown);
  EXPECT_THROW(loadChanges(dir / "unknown.ply"), IoError);
  EXPECT_THROW(loadChanges(dir / "none.ply"), IoError);
  EXPECT_THROW(saveChanges("/nowhere/changes.ply", fewChanges(Vec3::Zero())), IoError);
}

}  // namespace
}  // namespace paloc

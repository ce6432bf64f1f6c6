#include "paloc/tools/synth_change.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "paloc/core/errors.h"
#include "paloc/tools/synth_changed_scene.h"
#include "paloc/tools/synth_walk.h"

namespace paloc::synth {
namespace {

constexpr TimeNs kStart = 1'700'000'000 * kNsPerSecond;

const Scene& building() {
  static const Scene scene = makeScene("building");
  return scene;
}

const Raycaster& buildingRays() {
  static const Raycaster raycaster(building().mesh);
  return raycaster;
}

const Motion& walk() {
  static const Motion motion = makeWalk(building().route, 40, kStart, 1);
  return motion;
}

ChangedScene changed(const std::vector<std::string>& texts) {
  std::vector<Change> changes;
  for (const std::string& text : texts) changes.push_back(parseChange(text));
  return changeScene(building(), changes, walk(), buildingRays());
}

double distance(const Raycaster& raycaster, const Vec3& from, const Vec3& direction) {
  const Eigen::Vector3f d = direction.normalized().cast<float>();
  RayHit hit;
  raycaster.cast(from, {&d, 1}, {&hit, 1});
  return static_cast<double>(hit.distance_m);
}

TEST(SynthChange, IsReadWithItsValues) {
  EXPECT_TRUE(parseChange("glass").values.empty());
  const Change wall = parseChange("moved-wall=-0.25,1");
  EXPECT_EQ(wall.kind, ChangeKind::kMovedWall);
  EXPECT_EQ(wall.values, (std::vector<double>{-0.25, 1}));
  for (const std::string& name : changeNames()) EXPECT_EQ(toString(parseChange(name).kind), name);
  for (const char* bad :
       {"", "moved", "glass=1", "moved-wall=", "moved-wall=1m", "moved-wall=1,0,2",
        "missing-part=1,2", "added-box=nan", "moved-wall=1e9"}) {
    EXPECT_THROW(parseChange(bad), UsageError) << bad;
  }
}

TEST(SynthChange, WhatASceneHasNotCannotBeChanged) {
  Scene bare = building();
  bare.changeables = {};
  for (const char* text : {"moved-wall", "removed-furniture", "glass", "missing-part"}) {
    EXPECT_THROW(changeScene(bare, {parseChange(text)}, walk(), buildingRays()), UsageError)
        << text;
  }
  for (const char* text : {"moved-wall=0.3,9", "moved-wall=0.3,0.5", "walking-people=0",
                           "added-box=1.5", "missing-part=1,0,0,1"}) {
    EXPECT_THROW(changed({text}), UsageError) << text;
  }
}

TEST(SynthChange, AMovedWallStandsElsewhere) {
  const ChangedScene scene = changed({"moved-wall=0.3"});
  const Raycaster raycaster(scene.mesh);
  const Vec3 in_n1(2.0, 10.8, 2.3);
  EXPECT_NEAR(distance(raycaster, in_n1, Vec3::UnitX()),
              distance(buildingRays(), in_n1, Vec3::UnitX()) + 0.3, 1e-4);
  ASSERT_EQ(scene.objects.size(), 1U);
  const OrientedBox &gone = scene.objects[0].gone[0], &added = scene.objects[0].added[0];
  EXPECT_NEAR((added.low - gone.low - Vec3(0.3, 0, 0)).norm(), 0, 1e-4);
  EXPECT_NEAR(gone.high.z() - gone.low.z(), 3.0, 1e-4);
}

TEST(SynthChange, RemovedFurnitureIsGone) {
  const ChangedScene scene = changed({"removed-furniture"});
  ASSERT_EQ(scene.objects.size(), building().changeables.furniture.size());
  const Raycaster raycaster(scene.mesh);
  for (const ChangedObject& object : scene.objects) {
    // From above, through its top: the floor is what is left below.
    const OrientedBox& box = object.gone.at(0);
    const Vec3 above((box.low.x() + box.high.x()) / 2, (box.low.y() + box.high.y()) / 2, 2.2);
    EXPECT_LT(distance(buildingRays(), above, -Vec3::UnitZ()), 2.0) << object.name;
    EXPECT_NEAR(distance(raycaster, above, -Vec3::UnitZ()), 2.2, 1e-3) << object.name;
  }
}

TEST(SynthChange, AddedBoxesStandBesideTheWay) {
  const ChangedScene scene = changed({"added-box=4"});
  ASSERT_EQ(scene.objects.size(), 4U);
  const Raycaster raycaster(scene.mesh);
  for (const ChangedObject& object : scene.objects) {
    const Vec3 place = object.added.at(0).T_scene_box.position;
    EXPECT_NEAR(distance(raycaster, place + Vec3(0, 0, 1.0), -Vec3::UnitZ()), 0.1, 1e-3);
    double nearest = 100;
    for (double t = 0; t < 40; t += 0.1) {
      const Vec3 p = walk().at(kStart + nsFromSeconds(t)).T_map_body.position;
      nearest = std::min(nearest, (p - place).head<2>().norm());
    }
    EXPECT_GT(nearest, 0.7) << object.name;
    EXPECT_LT(nearest, 1.2) << object.name;
  }
}

TEST(SynthChange, PeopleWalkAtAPersonsPaceAndAreHit) {
  const ChangedScene scene = changed({"walking-people=3"});
  const Raycaster raycaster(scene.mesh);
  const Surroundings surroundings = scene.surroundings(raycaster);
  RandomStream random(1, RandomPurpose::kScan, 0);
  ASSERT_EQ(scene.people.tracks().size(), 3U);
  for (const WalkingPeople::Track& track : scene.people.tracks()) {
    double way = 0, fastest = 0;
    for (std::size_t i = 1; i < track.size(); ++i) {
      const double step = (track[i] - track[i - 1]).norm();
      way += step;
      fastest = std::max(fastest, step / WalkingPeople::kStep_s);
    }
    EXPECT_GT(way, 15);
    EXPECT_LT(fastest, 4);  // in the outer lane of a sharp turn
    const std::size_t step = 300;
    const Vec3 from = track[step] + Vec3(0.4, 0, 1.2);
    const Eigen::Vector3f d = -Eigen::Vector3f::UnitX();
    RayHit hit;
    surroundings.cast(kStart + nsFromSeconds(step * WalkingPeople::kStep_s), from, {&d, 1}, random,
                      {&hit, 1});
    EXPECT_NEAR(hit.distance_m, 0.4 - scene.people.shape().radius_m, 1e-3);
    EXPECT_EQ(hit.surface, scene.people_surface);
  }
}

TEST(SynthChange, APaneShowsAMirrorImageBehindIt) {
  SceneMesh mesh;
  {
    MeshBuilder builder;
    builder.box(Pose{}, Vec3(-2, -2, 0), Vec3(-1.9, 2, 3), 0.7F);  // behind the sensor
    mesh = builder.take();
  }
  const Raycaster raycaster(mesh);
  Surroundings surroundings(raycaster);
  surroundings.panes = {{onFloor(1, -1, 90), 2, 3}};
  const Eigen::Vector3f ahead = Eigen::Vector3f(1, 0.1F, 0.05F).normalized();
  int mirrored = 0, nothing = 0;
  RandomStream random(1, RandomPurpose::kScan, 0);
  for (int i = 0; i < 1000; ++i) {
    RayHit hit;
    surroundings.cast(0, Vec3(0, 0, 1), {&ahead, 1}, random, {&hit, 1});
    if (!hit.valid()) {
      ++nothing;
    } else if (hit.distance_m > 2) {
      ++mirrored;
      // The wall at x = -1.9, mirrored at x = 1.
      EXPECT_NEAR(hit.distance_m * ahead.x(), 3.9, 1e-4);
      EXPECT_NEAR(hit.normal_scene.x(), -1, 1e-5);
    } else {
      EXPECT_NEAR(hit.distance_m * ahead.x(), 1, 1e-4);  // the pane itself
    }
  }
  EXPECT_NEAR(mirrored, 300, 60);
  EXPECT_NEAR(nothing, 200, 50);
}

TEST(SynthChange, TheMapMissesAPart) {
  const ChangedScene scene = changed({"missing-part=0,1,0,1"});
  PointCloud map;
  map.points = {{0.5F, 0.5F, 2}, {1.5F, 0.5F, 2}, {0.5F, -0.5F, 2}};
  map.intensity = {1, 2, 3};
  scene.cut(map);
  ASSERT_EQ(map.size(), 2U);
  EXPECT_EQ(map.intensity[0], 2);
  EXPECT_EQ(map.points[1].y, -0.5F);
}

TEST(SynthChange, TheTruthNamesAllThatChanged) {
  const auto truth = describeChanges(changed({"moved-wall", "removed-furniture=2", "added-box=1",
                                              "walking-people", "glass", "missing-part"}));
  EXPECT_EQ(truth.at("objects").size(), 4U);
  EXPECT_EQ(truth.at("people").at("tracks_m").size(), 4U);
  EXPECT_EQ(truth.at("panes").size(), building().changeables.panes.size());
  EXPECT_EQ(truth.at("missing_from_map").size(), 1U);
}

}  // namespace
}  // namespace paloc::synth

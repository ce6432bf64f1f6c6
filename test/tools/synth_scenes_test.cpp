#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "paloc/tools/synth_scene.h"
#include "paloc/tools/synth_sensor.h"
#include "paloc/tools/synth_survey.h"
#include "paloc/tools/synth_walk.h"

namespace paloc::synth {
namespace {

constexpr double kDegree = std::numbers::pi / 180;

/// Distances to the nearest surfaces along unit vectors.
std::vector<RayHit> castFrom(const Scene& scene, const Vec3& origin,
                             const std::vector<Vec3>& directions) {
  const Raycaster raycaster(scene.mesh);
  std::vector<Eigen::Vector3f> rays;
  for (const Vec3& d : directions) rays.push_back(d.cast<float>());
  std::vector<RayHit> hits(rays.size());
  raycaster.cast(origin, rays, hits);
  return hits;
}

/// Directions of a regular grid over the sphere.
std::vector<Vec3> allAround() {
  std::vector<Vec3> directions;
  for (int e = -80; e <= 80; e += 4) {
    for (int a = 0; a < 360; a += 2) {
      directions.push_back(so3::exp(Vec3(0, 0, a * kDegree)) * so3::exp(Vec3(0, -e * kDegree, 0)) *
                           Vec3::UnitX());
    }
  }
  return directions;
}

class EveryScene : public testing::TestWithParam<std::string> {};

TEST_P(EveryScene, CanBeWalkedAndSurveyed) {
  const Scene scene = makeScene(GetParam());
  EXPECT_EQ(scene.name, GetParam());
  const Raycaster raycaster(scene.mesh);
  const Motion walk = makeWalk(scene.route, 120, 0, 3);
  std::vector<Eigen::Vector3f> rays;
  for (const Vec3& d : allAround()) rays.push_back(d.cast<float>());
  std::vector<RayHit> hits(rays.size());
  for (double t = 0; t < 120; t += 0.5) {
    const Vec3 at = walk.at(nsFromSeconds(t)).T_map_body.position;
    ASSERT_TRUE(at.allFinite());
    raycaster.cast(at, rays, hits);
    const auto nearest = std::min_element(
        hits.begin(), hits.end(), [](auto& a, auto& b) { return a.distance_m < b.distance_m; });
    EXPECT_GT(nearest->distance_m, 0.15F) << "at " << at.transpose();
    EXPECT_LT(nearest->distance_m, 3.0F) << "at " << at.transpose();
  }
  SurveyModel model;
  model.angular_step_deg = 4;
  EXPECT_GT(survey(model, scene.mesh, raycaster, scene.survey_stations, 1).size(), 3000U);
}

INSTANTIATE_TEST_SUITE_P(Synth, EveryScene, testing::ValuesIn(sceneNames()), [](const auto& scene) {
  std::string name = scene.param;
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
});

TEST(SynthScenes, NothingEndsTheViewAlongTheCorridor) {
  const std::pair<double, double> corridors[] = {{0, 76}, {30, 76}, {45, 76}, {45, 36}};
  for (const auto& [yaw_deg, length_m] : corridors) {
    const Scene scene = makeCorridor(yaw_deg, length_m);
    const Vec3 axis = so3::exp(Vec3(0, 0, yaw_deg * kDegree)) * Vec3::UnitX();
    const Vec3 left = Vec3::UnitZ().cross(axis);
    for (double x = kCorridorMouthM; x <= length_m - kCorridorMouthM; x += 4) {
      for (const RayHit& hit :
           castFrom(scene, x * axis + 0.4 * left + 1.35 * Vec3::UnitZ(), allAround())) {
        if (!hit.valid()) continue;
        EXPECT_LT(std::abs(hit.normal_scene.cast<double>().dot(axis)), 1e-4);
      }
    }
    const auto in_room = castFrom(scene, -3.5 * axis + 1.35 * Vec3::UnitZ(), allAround());
    EXPECT_GT(std::count_if(in_room.begin(), in_room.end(),
                            [&](const RayHit& hit) {
                              return std::abs(hit.normal_scene.cast<double>().dot(axis)) > 0.9;
                            }),
              100);
  }
}

// The noise of a range moves a point along its ray, on a wall seen aslant also along the wall. One
// point of each voxel is kept: were it the first of the sweep, it would be too near on one side of
// the station and too far on the other.
TEST(SynthSurvey, WhatIsKeptOfAVoxelIsOffItsWallNeitherWay) {
  const Scene scene = makeScene("room");
  const Raycaster raycaster(scene.mesh);
  SurveyModel model;
  model.range_noise_m = 0.01;
  model.surface_bias_m = 0;
  const Vec3 station = scene.survey_stations.front();
  // Above the furniture.
  const Vec3 high(station.x(), station.y(), 2.2);
  const double wall_x =
      high.x() + static_cast<double>(castFrom(scene, high, {Vec3::UnitX()})[0].distance_m);
  double count = 0, off_sum = 0, aside_sum = 0, products = 0, squares = 0;
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    for (const Point3f& p : survey(model, scene.mesh, raycaster, {station}, seed).points) {
      const double off = static_cast<double>(p.x) - wall_x;
      const double aside = static_cast<double>(p.y) - station.y();
      if (std::abs(off) > 0.04 || std::abs(aside) > 1.5) continue;
      ++count;
      off_sum += off;
      aside_sum += aside;
      products += off * aside;
      squares += aside * aside;
    }
  }
  const double slope =
      (products - off_sum * aside_sum / count) / (squares - aside_sum * aside_sum / count);
  EXPECT_LT(std::abs(slope), 3e-5);
}

TEST(SynthScenes, TheRoundHallIsRoundAndTheTunnelSmooth) {
  const Vec3 middle(0, 0, 1.4);
  for (const RayHit& hit : castFrom(makeCircularHall(), middle, allAround())) {
    ASSERT_TRUE(hit.valid());
    // The normal of a wall leads through the hall's axis: no lever for a turn.
    const double up = std::abs(static_cast<double>(hit.normal_scene.z()));
    EXPECT_TRUE(up > 0.999 || up < 1e-3);
  }
  std::size_t open = 0;
  for (const RayHit& hit : castFrom(makeTunnel(), Vec3(50, 0.5, 1.4), allAround())) {
    if (!hit.valid()) {
      ++open;
      continue;
    }
    EXPECT_LT(std::abs(hit.normal_scene.x()), 1e-4F);
  }
  EXPECT_GT(open, 0U);
}

TEST(SynthSensors, TheSolidStateOneSeesItsFieldOnlyFromLeftToRight) {
  const SensorModel sensor = makeSensor("solid-state");
  const Scene scene = makeRoom();
  const Raycaster raycaster(scene.mesh);
  const Motion still({Pose{Vec3(3, 2, 1.4), Mat3::Identity()}}, 0.05, 0);
  const Surroundings surroundings(raycaster);
  const auto scan = LidarSimulator(sensor, Pose{}, scene.mesh, surroundings, still, 1).scan(0, 0);
  ASSERT_GT(scan->size(), 20'000U);
  EXPECT_LE(scan->size(), 144U * 192U);
  double leftmost = -10, rightmost = 10, highest = -10, lowest = 10;
  for (std::size_t i = 0; i < scan->size(); ++i) {
    const double azimuth = std::atan2(scan->y[i], scan->x[i]);
    const double elevation = std::atan2(scan->z[i], std::hypot(scan->x[i], scan->y[i]));
    leftmost = std::max(leftmost, azimuth), rightmost = std::min(rightmost, azimuth);
    highest = std::max(highest, elevation), lowest = std::min(lowest, elevation);
    const double column = (sensor.first_azimuth_rad - azimuth) / sensor.field_rad * 192;
    EXPECT_NEAR(static_cast<double>(scan->dt_ns[i]), column * 1e8 / 192, 1e8 / 192 * 0.01);
  }
  EXPECT_NEAR(leftmost, 60 * kDegree, 0.01);
  EXPECT_NEAR(rightmost, -60 * kDegree, 0.01);
  EXPECT_NEAR(highest, 45 * kDegree, 0.01);
  EXPECT_NEAR(lowest, -45 * kDegree, 0.01);
}

}  // namespace
}  // namespace paloc::synth

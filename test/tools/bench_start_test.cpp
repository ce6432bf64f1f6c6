#include "paloc/tools/bench_start.h"

#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "paloc/tools/bench_place.h"

namespace paloc {
namespace {

BenchStartSettings small() {
  BenchStartSettings settings;
  settings.scene = "room";
  settings.sensor = "vlp-16";
  settings.places = 2;
  settings.partial = settings.wrong = settings.storeys = 0;
  settings.map_spacing_m = 0.08;
  settings.survey_step_deg = 0.5;
  return settings;
}

TEST(BenchStart, FindsWhatIsInTheMapFromEveryKindOfStart) {
  const auto rows = benchStart(small(), [](const std::string&, double) {});
  ASSERT_EQ(rows.size(), 6U);
  for (const BenchStartRow& row : rows) {
    EXPECT_EQ(row.starts, 2U);
    EXPECT_EQ(row.found + row.accepted + row.refused.size(), 2U) << row.kind;
    EXPECT_GE(row.found, 1U) << row.kind << tableOf(rows);
    EXPECT_EQ(row.locate_ms.size(), 2U);
  }
  const auto json = jsonOf(rows);
  EXPECT_EQ(json.at("rows").size(), 6U);
  EXPECT_EQ(json.at("rows")[0].at("known"), "1 m, 15 deg");
  EXPECT_NE(tableOf(rows).find("nothing"), std::string::npos);
}

TEST(BenchStart, TellsMapsOfWhichAPartIsMissing) {
  BenchStartSettings settings = small();
  settings.places = 0;
  settings.partial = 1;
  const auto rows = benchStart(settings, [](const std::string&, double) {});
  ASSERT_EQ(rows.size(), 6U);
  EXPECT_EQ(rows[0].starts, 1U);
  EXPECT_EQ(rows[0].accepted, 0U) << tableOf(rows);
  EXPECT_EQ(jsonOf(rows).at("rows")[0].at("map"), "part");
}

// From the same places most rays end where they did, on walls, floor and ceiling, and some do not.
TEST(BenchPlace, AnotherStoreyHasTheSameWallsAndOtherFurniture) {
  const synth::Scene building = synth::makeBuilding();
  const synth::Raycaster a(building.mesh);
  for (const std::uint64_t storey : {1U, 2U}) {
    const synth::Scene other = synth::makeBuildingStorey(storey);
    const synth::Raycaster b(other.mesh);
    std::size_t rays = 0, same = 0;
    for (const Vec3& station : building.survey_stations) {
      std::vector<Eigen::Vector3f> directions;
      for (int i = 0; i < 360; ++i) {
        const float angle = 0.0174533F * static_cast<float>(i),
                    down = 0.1F * static_cast<float>(i % 9 - 5);
        directions.emplace_back(
            Eigen::Vector3f(std::cos(angle), std::sin(angle), down).normalized());
      }
      std::vector<synth::RayHit> hit_a(directions.size()), hit_b(directions.size());
      a.cast(station, directions, hit_a);
      b.cast(station, directions, hit_b);
      for (std::size_t i = 0; i < directions.size(); ++i) {
        ++rays;
        same += std::abs(hit_a[i].distance_m - hit_b[i].distance_m) < 0.01F ? 1U : 0U;
      }
    }
    EXPECT_GT(same, rays / 2);
    EXPECT_LT(same, rays * 9 / 10);
  }
}

TEST(BenchPlace, MirrorImageIsTheSameSceneTheOtherWayRound) {
  const synth::Scene room = synth::makeRoom(), image = mirrored(room);
  ASSERT_EQ(image.mesh.vertices.size(), room.mesh.vertices.size());
  EXPECT_EQ(image.mesh.vertices[7].x, room.mesh.vertices[7].x);
  EXPECT_EQ(image.mesh.vertices[7].y, -room.mesh.vertices[7].y);
  // Still seen from the side that it was seen from: a ray from the room's inside ends at the same
  // distance.
  const synth::Raycaster a(room.mesh), b(image.mesh);
  std::vector<synth::RayHit> hit_a(1), hit_b(1);
  const Vec3 from = room.survey_stations[0], from_b(from.x(), -from.y(), from.z());
  a.cast(from, std::vector<Eigen::Vector3f>{{0.6F, 0.8F, 0}}, hit_a);
  b.cast(from_b, std::vector<Eigen::Vector3f>{{0.6F, -0.8F, 0}}, hit_b);
  EXPECT_NEAR(hit_a[0].distance_m, hit_b[0].distance_m, 1e-4);
}

}  // namespace
}  // namespace paloc

#include "paloc/tools/bench_start.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "paloc/tools/bench_place.h"

namespace paloc {
namespace {

BenchStartSettings small() {
  BenchStartSettings settings;
  settings.scene = "room";
  settings.sensor = "vlp-16";
  settings.places = 2;
  settings.wrong = 0;
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

#include "paloc/tools/eval_changes.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "paloc/core/errors.h"
#include "temp_dir.h"

namespace paloc {
namespace {

// A table gone from the origin, turned by 90 degrees; a box added at x = 5; a person walking along
// y = 10; no map beyond x = 20.
constexpr const char* kTruth = R"({
  "frame": "map",
  "objects": [
    {"change": "removed-furniture", "name": "table", "added": [],
     "gone": [{"T_map_box": {"position_m": [0, 0, 0],
                             "quaternion_xyzw": [0, 0, 0.70710678118, 0.70710678118]},
               "low_m": [-1, -0.3, 0], "high_m": [1, 0.3, 0.8]}]},
    {"change": "added-box", "name": "box", "gone": [],
     "added": [{"T_map_box": {"position_m": [5, 0, 0], "quaternion_xyzw": [0, 0, 0, 1]},
                "low_m": [-0.5, -0.5, 0], "high_m": [0.5, 0.5, 1]}]}],
  "people": {"radius_m": 0.2, "height_m": 1.7, "start_ns": 0, "step_s": 0.1,
             "tracks_m": [[[0, 10, 0], [1, 10, 0], [2, 10, 0]]]},
  "panes": [],
  "missing_from_map": [{"low_m": [20, -5, -1], "high_m": [30, 5, 3]}]
})";

ChangeTruth truth() {
  const test::TempDir dir;
  test::writeFile(dir / "changes.json", kTruth);
  return ChangeTruth::load(dir / "changes.json");
}

void report(MapChanges& changes, MapChange kind, const std::vector<Point3f>& points) {
  for (const Point3f& p : points) {
    changes.cloud.points.push_back(p);
    changes.kinds.push_back(kind);
  }
}

TEST(ChangeTruth, KnowsWhereThingsAre) {
  const ChangeTruth t = truth();
  ASSERT_EQ(t.gone.size(), 1U);
  ASSERT_EQ(t.added.size(), 1U);
  EXPECT_TRUE(t.gone[0].contains({0.25, 0.9, 0.5}, 0, 0));  // long along y, since it is turned
  EXPECT_FALSE(t.gone[0].contains({0.9, 0.25, 0.5}, 0, 0));
  EXPECT_TRUE(t.gone[0].contains({0.34, 0.9, 0.5}, 0.05, 0));
  EXPECT_FALSE(t.gone[0].contains({0.25, 0.9, 0.05}, 0, -0.1));
  EXPECT_TRUE(t.sweptByPeople({1.5, 10.19, 1}, 0, 0));
  EXPECT_FALSE(t.sweptByPeople({1.5, 10.25, 1}, 0, 0));
  EXPECT_TRUE(t.sweptByPeople({1.5, 10.24, 1}, 0.05, 0));
  EXPECT_FALSE(t.sweptByPeople({1.5, 10, 1.9}, 0.05, 0));
  EXPECT_FALSE(t.sweptByPeople({4, 10, 1}, 0.05, 0));
  EXPECT_TRUE(t.missing.at(0).contains({25, 0, 1}, 0));
}

TEST(EvalChanges, CountsWhatIsRightAndWhatIsFound) {
  EvalChangesInput input;
  report(input.changes, MapChange::kGone, {{0, 0, 0.8F}, {0.1F, 0.5F, 0.8F}, {2, 0, 0.8F}});
  report(input.changes, MapChange::kAdded, {{5, 0, 1}, {0, 0, 0.8F}});
  report(input.changes, MapChange::kMoved, {{1, 10, 1}});
  // On the table: two near reported points, two not; on the floor below it, and elsewhere.
  input.map.points = {{0.01F, 0, 0.8F},    {0.1F, 0.55F, 0.8F}, {0.2F, -0.5F, 0.8F},
                      {0.2F, -0.9F, 0.8F}, {0, 0, 0},           {7, 7, 0}};
  input.scans.points = {{5, 0.02F, 1}, {4.6F, 0, 1}, {1, 10, 1.05F}, {1.5F, 10, 0.05F}};
  const EvalChangesResult result = evaluateChanges(truth(), input, 0.05);
  const ChangeScore &gone = result.kinds[0], &added = result.kinds[1], &moved = result.kinds[2];
  EXPECT_EQ(gone.reported, 3U);
  EXPECT_EQ(gone.correct, 2U);
  EXPECT_EQ(gone.there, 4U);
  EXPECT_EQ(gone.found, 2U);
  EXPECT_DOUBLE_EQ(gone.precision().value_or(0), 2.0 / 3);
  EXPECT_DOUBLE_EQ(gone.recall().value_or(0), 0.5);
  EXPECT_DOUBLE_EQ(added.precision().value_or(0), 0.5);
  EXPECT_DOUBLE_EQ(added.recall().value_or(0), 0.5);
  EXPECT_EQ(moved.there, 1U);
  EXPECT_DOUBLE_EQ(moved.recall().value_or(0), 1);
  EXPECT_FALSE(result.kinds[3].precision().has_value());
  ASSERT_EQ(result.objects.size(), 2U);
  EXPECT_EQ(result.objects[0].name, "table");
  EXPECT_EQ(result.objects[0].found, 2U);

  const auto json = jsonOf(result);
  EXPECT_EQ(json.at("gone").at("found"), 2);
  EXPECT_TRUE(json.at("unmapped").at("precision").is_null());
  EXPECT_NE(tableOf(result).find("66.7 %"), std::string::npos);
}

}  // namespace
}  // namespace paloc

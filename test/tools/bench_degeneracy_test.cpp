#include "paloc/tools/bench_degeneracy.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "paloc/core/errors.h"
#include "paloc/tools/quantile.h"

namespace paloc {
namespace {

BenchDegeneracySettings small() {
  BenchDegeneracySettings settings;
  settings.poses = 6;
  settings.map_spacing_m = 0.05;
  settings.survey_step_deg = 0.4;
  return settings;
}

TEST(BenchDegeneracy, FindsTheCorridorsAxisAndNothingElse) {
  BenchDegeneracySettings settings = small();
  settings.scenes = {"room", "corridor-30", "circular-hall"};
  settings.sensors = {"vlp-16", "solid-state"};
  std::vector<std::string> told;
  const auto rows =
      benchDegeneracy(settings, [&](const std::string& what) { told.push_back(what); });
  ASSERT_EQ(rows.size(), 6U);
  EXPECT_EQ(told.size(), 6U);
  DegeneracyScore all;
  for (const BenchDegeneracyRow& row : rows) {
    EXPECT_EQ(row.score.poses + row.score.refused, 6U) << row.scene;
    EXPECT_EQ(row.score.refused, 0U) << row.scene;
    all.merge(row.score);
  }
  EXPECT_GT(all.degenerate, 10U);
  EXPECT_GE(all.f1(), 0.98);
  EXPECT_LE(all.falseAlarmRate(), 0.005);
  EXPECT_LE(quantile(all.axis_errors_deg, 0.95), 3);
  EXPECT_EQ(jsonOf(rows).at("rows").size(), 6U);
  EXPECT_NE(tableOf(rows).find("corridor-30"), std::string::npos);
}

TEST(BenchDegeneracy, KnowsItsNames) {
  BenchDegeneracySettings settings = small();
  settings.scenes = {"castle"};
  EXPECT_THROW(benchDegeneracy(settings, [](const std::string&) {}), UsageError);
  settings.scenes = {"room"};
  settings.sensors = {"sonar"};
  EXPECT_THROW(benchDegeneracy(settings, [](const std::string&) {}), UsageError);
}

}  // namespace
}  // namespace paloc

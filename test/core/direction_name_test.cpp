#include "paloc/core/direction_name.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "paloc/core/so3.h"

namespace paloc {
namespace {

constexpr double kDegree = std::numbers::pi / 180;

Vec3 xTurnedBy(double yaw_deg) { return so3::exp(Vec3(0, 0, yaw_deg * kDegree)) * Vec3::UnitX(); }

TEST(DirectionName, NamesTheBodyAxisThatItLiesAlong) {
  EXPECT_EQ(directionName(Vec3::UnitX(), false), "along body x (heading)");
  EXPECT_EQ(directionName(-Vec3::UnitY(), false), "along body y (sideways)");
  EXPECT_EQ(directionName(Vec3::UnitZ(), false), "along body z (height)");
  EXPECT_EQ(directionName(Vec3::UnitX(), true), "roll");
  EXPECT_EQ(directionName(Vec3::UnitY(), true), "pitch");
  EXPECT_EQ(directionName(-Vec3::UnitZ(), true), "yaw");
  EXPECT_EQ(directionName(xTurnedBy(19), false), "along body x (heading)");
  EXPECT_EQ(directionName(xTurnedBy(-71), false), "along body y (sideways)");
}

TEST(DirectionName, SaysOfALeaningAxisWhereItLeans) {
  EXPECT_EQ(directionName(xTurnedBy(45), false), "diagonal along body +x+y");
  EXPECT_EQ(directionName(xTurnedBy(-45), false), "diagonal along body +x-y");
  EXPECT_EQ(directionName(Vec3(-1, 0, 1).normalized(), true), "diagonal about body +x-z");
  EXPECT_EQ(directionName(Vec3(1, 1, 1).normalized(), false), "diagonal along body +x+y+z");
}

TEST(DirectionName, OfAnyAxisAndItsOppositeIsOneAndNeverEndsInTheAir) {
  for (int i = 0; i < 2000; ++i) {
    const double z = std::cos(0.1 * i), level = std::sqrt(1 - z * z);
    const Vec3 axis(level * std::cos(2.4 * i), level * std::sin(2.4 * i), z);
    for (const bool rotation : {false, true}) {
      const std::string name = directionName(axis, rotation);
      EXPECT_EQ(name, directionName(-axis, rotation));
      EXPECT_EQ(name.find(','), std::string::npos);
      if (!name.starts_with("diagonal")) continue;
      EXPECT_GE(name.substr(name.rfind(' ') + 1).size(), 4U) << axis.transpose();  // two axes
    }
  }
}

TEST(DirectionName, IsEmptyWithoutAnAxis) { EXPECT_EQ(directionName(Vec3::Zero(), true), ""); }

}  // namespace
}  // namespace paloc

#include "paloc/map/surface_register.h"

#include <gtest/gtest.h>

#include "paloc/core/so3.h"

namespace paloc {
namespace {

constexpr double kReach_m = 10;

TEST(SurfaceRegister, AWallIsOneSurfaceHoweverLongItIs) {
  SurfaceRegister surfaces(kReach_m);
  for (int k = 0; k < 100; ++k) {
    const Vec3 wobble(0.004 * (k % 3), 0.006 * (k % 2), 1);
    const double along = -300 + 8 * k;
    EXPECT_EQ(surfaces.surfaceOf(wobble.normalized(), Vec3(along, 2, 0.02 * (k % 4))), 0) << k;
  }
  EXPECT_EQ(surfaces.size(), 1);
}

TEST(SurfaceRegister, OtherPlanesAreOtherSurfaces) {
  SurfaceRegister surfaces(kReach_m);
  const Vec3 at(3, 2, 1);
  EXPECT_EQ(surfaces.surfaceOf(Vec3::UnitZ(), at), 0);
  EXPECT_EQ(surfaces.surfaceOf(-Vec3::UnitZ(), at), 1) << "its other side";
  EXPECT_EQ(surfaces.surfaceOf(Vec3::UnitZ(), at + Vec3(1, 0, 0.15)), 2) << "a step";
  EXPECT_EQ(surfaces.surfaceOf(Vec3::UnitX(), at), 3);
  EXPECT_EQ(surfaces.surfaceOf(Vec3::UnitZ(), at + Vec3(12, 0, 0)), 4) << "far away";
  EXPECT_EQ(surfaces.surfaceOf(Vec3::UnitZ(), at + Vec3(0.5, 0, 0)), 0) << "seen again";
  EXPECT_EQ(surfaces.size(), 5);
}

// By its first normal: else it would be one with what lies across the hall.
TEST(SurfaceRegister, ARoundWallIsSeveral) {
  SurfaceRegister surfaces(kReach_m);
  for (int deg = 0; deg < 360; deg += 2) {
    const Vec3 outwards = so3::exp(Vec3(0, 0, deg * 0.0174532925)) * Vec3::UnitX();
    surfaces.surfaceOf(-outwards, 8 * outwards);
  }
  EXPECT_GE(surfaces.size(), 360 / 24);
  EXPECT_LE(surfaces.size(), 180);
}

}  // namespace
}  // namespace paloc

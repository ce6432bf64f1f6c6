#include <gtest/gtest.h>

#include "paloc/frontends/map_scale_check.h"

namespace paloc {
namespace {

// Floor and a wall of a hall of 40 x 25 x 6 m, a point each 0.2 m, in units of `unit_m`.
PointCloud hall(double unit_m) {
  PointCloud map;
  const auto add = [&](double x, double y, double z) {
    map.points.push_back({static_cast<float>(x / unit_m), static_cast<float>(y / unit_m),
                          static_cast<float>(z / unit_m)});
  };
  for (double x = 0; x < 40; x += 0.2) {
    for (double y = 0; y < 25; y += 0.2) add(x, y, 0);
    for (double z = 0; z < 6; z += 0.2) add(x, 0, z);
  }
  return map;
}

TEST(MapScaleCheck, LetsMapsInMetresPass) {
  for (const double reach_m : {3.0, 15.0, 60.0}) {
    EXPECT_TRUE(checkMapScale(hall(1), "hall", reach_m).empty()) << reach_m;
  }
  PointCloud stray = hall(1);
  stray.points.push_back({1e6F, 0, 0});
  EXPECT_TRUE(checkMapScale(stray, "hall", 15).empty());
  EXPECT_TRUE(checkMapScale(hall(1e-3), "hall", 0).empty());  // no scan to compare with
  EXPECT_TRUE(checkMapScale({}, "nothing", 15).empty());
}

TEST(MapScaleCheck, NamesMapsInOtherUnits) {
  for (const double unit_m : {1e-3, 1e-2}) {
    const Findings findings = checkMapScale(hall(unit_m), "hall", 15);
    ASSERT_EQ(findings.size(), 1U) << unit_m;
    EXPECT_NE(findings[0].sentence.find("millimetres or centimetres"), std::string::npos);
    EXPECT_NEAR(findings[0].value.value(), 40 / unit_m, 2 / unit_m);
  }
  const Findings small = checkMapScale(hall(1e3), "hall", 15);
  ASSERT_EQ(small.size(), 1U);
  EXPECT_NE(small[0].sentence.find("kilometres"), std::string::npos);
}

}  // namespace
}  // namespace paloc

#include "paloc/map/spectrum.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "paloc/core/mrpt_pose.h"
#include "paloc/core/so3.h"
#include "paloc/map/scan_matcher.h"
#include "paloc/map/scan_normals.h"
#include "simulated_rooms.h"

namespace paloc {
namespace {

/// Points on the six faces of a room of 10 x 8 x 3 m about the origin, both normals exact.
std::vector<TwoNormals> room(int count, double ends = 1) {
  std::mt19937 random(4);
  std::uniform_real_distribution<double> uniform(-1, 1);
  const Vec3 half(5, 4, 1.5);
  std::vector<TwoNormals> points;
  while (count-- > 0) {
    const int axis = std::abs(uniform(random)) < ends / 3 ? 0 : 1 + count % 2;
    Vec3 p = half.cwiseProduct(Vec3(uniform(random), uniform(random), uniform(random)));
    p[axis] = uniform(random) > 0 ? half[axis] : -half[axis];
    points.push_back({p, Vec3::Unit(axis), Vec3::Unit(axis)});
  }
  return points;
}

std::vector<TwoNormals> noisy(std::vector<TwoNormals> points, double sigma_rad) {
  std::mt19937 random(5);
  std::normal_distribution<double> normal(0, sigma_rad);
  for (TwoNormals& p : points) {
    p.scan_normal = so3::exp(Vec3(normal(random), normal(random), normal(random))) * p.scan_normal;
  }
  return points;
}

TEST(Spectrum, IsZeroWhereScanAndMapAgreeWhateverTheSignsOfNormals) {
  std::vector<TwoNormals> points = room(300);
  for (std::size_t i = 0; i < points.size(); i += 3) points[i].map_normal *= -1;
  EXPECT_NEAR(spectrumDifference(points), 0, 1e-20);
}

TEST(Spectrum, GrowsWithTheNoiseOfTheScansNormals) {
  const double some = spectrumDifference(noisy(room(300), 0.02));
  const double more = spectrumDifference(noisy(room(300), 0.3));
  EXPECT_GT(some, 0);
  EXPECT_GT(more, 10 * some);
}

TEST(Spectrum, IsNotMonotoneInHowDegenerateAPlaceIs) {
  // Few points on the ends: the axis is all but free, both agree on that, and it stands alone. In
  // the room three directions are fixed alike, and noise turns them among each other.
  const double room_value = spectrumDifference(noisy(room(2000), 0.1));
  const double corridor_value = spectrumDifference(noisy(room(2000, 0.02), 0.1));
  EXPECT_LT(corridor_value, room_value + 0.01);
}

TEST(ScanNormals, FindTheRadiusForSoManyNeighbours) {
  std::vector<Point3f> points;
  for (int i = 0; i < 60; ++i) {
    for (int k = 0; k < 60; ++k) {
      points.push_back({0.2F * static_cast<float>(i), 0.2F * static_cast<float>(k), 1});
    }
  }
  const double radius = ScanNormals(points).radiusFor(15);
  EXPECT_NEAR(radius, 0.2 * std::sqrt(15 / 3.1416), 0.1);
}

TEST(Spectrum, HasNoUnitAndDoesNotCountPoints) {
  const std::vector<TwoNormals> points = noisy(room(300), 0.1);
  const double once = spectrumDifference(points);
  std::vector<TwoNormals> twice = points, in_feet = points;
  twice.insert(twice.end(), points.begin(), points.end());
  for (TwoNormals& p : in_feet) p.point_body /= 0.3048;
  EXPECT_NEAR(spectrumDifference(twice), once, 1e-9 * once);
  EXPECT_NEAR(spectrumDifference(in_feet), once, 1e-9 * once);
}

TEST(Spectrum, DoesNotMindTheOrderOfNearlyEqualEigenvalues) {
  // A cube's: the least noise swaps them. Matched by index the term would be near (1 - 0)^2.
  std::vector<TwoNormals> points;
  for (int axis = 0; axis < 3; ++axis) {
    for (int i = 0; i < 60; ++i) {
      Vec3 p = 2 * Vec3(std::sin(1.7 * i), std::sin(2.9 * i + 1), std::cos(1.3 * i));
      p[axis] = i % 2 == 0 ? 2 : -2;
      const int copies = axis == 0 ? 2 : 1;
      for (int c = 0; c < copies; ++c) points.push_back({p, Vec3::Unit(axis), Vec3::Unit(axis)});
    }
  }
  // On the map the middle and the last axis change places in size by a few points.
  std::vector<TwoNormals> other = points;
  for (std::size_t i = 0; i < 3; ++i) other[130 + i].map_normal = Vec3::UnitZ();
  EXPECT_LT(spectrumDifference(other), 0.5);
}

TEST(Spectrum, IsNotANumberWithTooFewPoints) {
  EXPECT_TRUE(std::isnan(spectrumDifference(room(11))));
  EXPECT_FALSE(std::isnan(spectrumDifference(room(60))));
}

TEST(ScanNormals, AreThoseOfTheSurfaceAndNoneOnALine) {
  std::mt19937 random(6);
  std::normal_distribution<double> normal(0, 0.01);
  const Vec3 n = Vec3(1, 2, 0.5).normalized(), u = n.unitOrthogonal(), v = n.cross(u);
  std::vector<Point3f> points;
  const auto push = [&](const Vec3& p) {
    points.push_back(
        {static_cast<float>(p.x()), static_cast<float>(p.y()), static_cast<float>(p.z())});
  };
  for (int i = -6; i <= 6; ++i) {
    for (int k = -6; k <= 6; ++k) push(3 * n + 0.1 * i * u + 0.1 * k * v + normal(random) * n);
  }
  for (int i = 0; i < 13; ++i) push(-3 * n + 0.02 * i * u);  // a line
  push(10 * n);                                              // alone
  const ScanNormals normals(points);
  const auto at = [&](std::size_t i) { return normals.at(points[i], 0.23); };
  EXPECT_GT(std::abs(at(84).dot(n)), std::cos(0.06));  // the middle of the plane
  EXPECT_TRUE(at(175).isZero());
  EXPECT_TRUE(at(182).isZero());
}

MapMatch matchIn(const test::BoxWorld& world, double max_range_m, MatcherSettings settings,
                 unsigned map_seed = 1) {
  const auto map = PriorMap::build(test::sampleMap(world, 0.1, 0.003, map_seed), {});
  const Pose truth = world.T_map_world * Pose{Vec3(0.5, 0.2, 1.2), so3::exp(Vec3(0, 0, 0.7))};
  const Scan scan = test::simulateScan(world, truth, 12000, {0.02}, max_range_m, 11);
  Vec6 off;
  off << 0.05, -0.04, 0.03, 0.004, -0.003, 0.005;
  return ScanMatcher::onto(map, settings)->match(scan, toMrpt(boxplus(truth, off)), 0.05, 0.01);
}

// Of one map it may be larger: two eigenvalues that are nearly equal share their vectors as they
// like (1 in 5 maps of this room gives more than 1).
TEST(Spectrum, OfMostMatchesIsSmallInARoom) {
  MatcherSettings settings;
  settings.spectrum = true;
  std::vector<double> spectra;
  for (unsigned map_seed = 1; map_seed <= 15; ++map_seed) {
    const MapMatch match = matchIn(test::furnishedRoom(), 30, settings, map_seed);
    ASSERT_TRUE(match.accepted());
    spectra.push_back(match.spectrum);
  }
  std::nth_element(spectra.begin(), spectra.begin() + 7, spectra.end());
  EXPECT_LT(spectra[7], 1);
}

TEST(Spectrum, OfAMatchIsTheSameOnAnyNumberOfThreads) {
  MatcherSettings settings;
  settings.spectrum = true;
  const MapMatch match = matchIn(test::furnishedRoom(), 30, settings);
  ASSERT_TRUE(match.accepted());
  EXPECT_GE(match.spectrum, 0);
  settings.threads = 1;
  EXPECT_EQ(matchIn(test::furnishedRoom(), 30, settings).spectrum, match.spectrum);
  settings.spectrum = false;
  const MapMatch without = matchIn(test::furnishedRoom(), 30, settings);
  EXPECT_TRUE(std::isnan(without.spectrum));
  EXPECT_EQ(without.information, match.information);  // it decides nothing
}

TEST(DegeneracyHandling, TurnedOffKeepsWhatTheEquationsClaim) {
  MatcherSettings settings;
  const test::BoxWorld world = test::corridor(0.5);
  const MapMatch handled = matchIn(world, 15, settings);
  settings.degeneracy_handling = false;
  settings.max_step_sigmas = 100;  // nothing holds it: it slides along the corridor
  const MapMatch claimed = matchIn(world, 15, settings);
  ASSERT_TRUE(handled.accepted() && claimed.accepted());
  const Vec3 axis_map = so3::exp(Vec3(0, 0, 0.5)) * Vec3::UnitX();
  const auto along = [&](const MapMatch& m) {
    // The rotation is free to follow.
    const Mat3 cross = m.information.topRightCorner<3, 3>();
    const Mat3 rotation = m.information.bottomRightCorner<3, 3>();
    const Mat3 position =
        m.information.topLeftCorner<3, 3>() - cross * rotation.inverse() * cross.transpose();
    return axis_map.dot(position * axis_map);
  };
  EXPECT_EQ(claimed.directions[0].cls, DirectionClass::kNone);  // it is told all the same
  EXPECT_GT(along(claimed), 20 * std::abs(along(handled)) + 20);
}

}  // namespace
}  // namespace paloc

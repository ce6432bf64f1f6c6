#include "paloc/map/search_points.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <unordered_map>

#include "paloc/map/voxel_filter.h"
#include "voxel_key.h"

namespace paloc {
namespace {

// A wall fills its column from floor to ceiling; floor and ceiling alone fill two bins or three,
// a table one more.
constexpr double kColumnM = 0.4, kBinM = 0.25;
constexpr int kMinBins = 4;
// Hundreds tell as much as thousands: a pose is right when nearly all points fit, at random a
// fifth of them does.
constexpr std::size_t kUpright = 220, kOthers = 80;
constexpr double kReachQuantile = 0.8;

std::uint64_t columnOf(const Point3f& p) {
  return voxelIndex(p.x, 1 / kColumnM) << kVoxelBits | voxelIndex(p.y, 1 / kColumnM);
}

// One bit for each bin of height that a point of the column falls into, 64 in turn.
std::uint64_t binOf(const Point3f& p) {
  return std::uint64_t{1} << (voxelIndex(p.z, 1 / kBinM) % 64);
}

// One point a voxel, which grows until there are no more than `count`.
std::vector<Vec3> evenly(const std::vector<Point3f>& points, double spacing_m, std::size_t count) {
  constexpr double kGrowth = 1.2;
  VoxelFilter filter;
  std::vector<std::uint32_t> kept = filter.select(points, spacing_m);
  while (kept.size() > count) kept = filter.select(points, spacing_m *= kGrowth);
  std::vector<Vec3> some;
  for (const std::uint32_t i : kept) {
    const Point3f& p = points[i];
    some.emplace_back(static_cast<double>(p.x), static_cast<double>(p.y), static_cast<double>(p.z));
  }
  return some;
}

}  // namespace

SearchPoints pickSearchPoints(std::span<const Point3f> points_body, const Mat3& R_level_body,
                              double spacing_m) {
  const Eigen::Matrix3f rotation = R_level_body.cast<float>();
  std::vector<Point3f> level(points_body.size());
  std::unordered_map<std::uint64_t, std::uint64_t> filled;
  for (std::size_t i = 0; i < level.size(); ++i) {
    const Point3f& p = points_body[i];
    const Eigen::Vector3f at = rotation * Eigen::Vector3f(p.x, p.y, p.z);
    level[i] = {at.x(), at.y(), at.z()};
    filled[columnOf(level[i])] |= binOf(level[i]);
  }
  std::vector<Point3f> upright, others;
  for (const Point3f& p : level) {
    const bool stands = std::popcount(filled[columnOf(p)]) >= kMinBins;
    (stands ? upright : others).push_back(p);
  }
  SearchPoints picked{evenly(upright, spacing_m, kUpright), evenly(others, spacing_m, kOthers), 0};
  std::vector<double> ranges;
  for (const Vec3& p : picked.upright) ranges.push_back(p.head<2>().norm());
  for (const Vec3& p : picked.others) ranges.push_back(p.head<2>().norm());
  if (ranges.empty()) return picked;
  const auto at =
      static_cast<std::ptrdiff_t>(kReachQuantile * static_cast<double>(ranges.size() - 1));
  std::nth_element(ranges.begin(), ranges.begin() + at, ranges.end());
  picked.reach_m = ranges[static_cast<std::size_t>(at)];
  return picked;
}

}  // namespace paloc

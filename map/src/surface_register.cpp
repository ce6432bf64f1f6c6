#include "paloc/map/surface_register.h"

#include <cmath>

namespace paloc {
namespace {

constexpr double kSamePlaneCosine = 0.978;  // 12 degrees
constexpr double kSamePlaneHeightM = 0.1;
// A patch further than so many reaches from all before it is kept as a place of its surface.
constexpr double kNewPlace = 0.25;

std::uint64_t keyOf(std::int64_t x, std::int64_t y, std::int64_t z) {
  const auto part = [](std::int64_t cell) {  // cells that coincide in 21 bits are far apart
    return static_cast<std::uint64_t>(cell) & 0x1fffffU;
  };
  return part(x) << 42U | part(y) << 21U | part(z);
}

}  // namespace

std::array<std::int64_t, 3> SurfaceRegister::cellOf(const Vec3& point) const {
  const auto cell = [this](double at) {
    return static_cast<std::int64_t>(std::floor(at / reach_m_));
  };
  return {cell(point.x()), cell(point.y()), cell(point.z())};
}

// The nearest place on the same plane in one cell, where it is nearer than what was found.
void SurfaceRegister::searchCell(std::uint64_t key, const Vec3& normal, const Vec3& point,
                                 Found& found) const {
  const auto cell = cells_.find(key);
  if (cell == cells_.end()) return;
  for (const Place& place : cell->second) {
    const Vec3& surface_normal = normals_[static_cast<std::size_t>(place.surface)];
    const Vec3 apart = point - place.point;
    const double distance = apart.norm();
    if (distance >= found.distance_m || surface_normal.dot(normal) < kSamePlaneCosine ||
        std::abs(apart.dot(normal + surface_normal)) > 2 * kSamePlaneHeightM) {
      continue;
    }
    found = {place.surface, distance};
  }
}

// The nearest place on the same plane; in the cell itself, if there is one as near as to be taken
// for the point's own.
SurfaceRegister::Found SurfaceRegister::nearest(const Vec3& normal, const Vec3& point) const {
  Found found{-1, reach_m_};
  const auto [x, y, z] = cellOf(point);
  searchCell(keyOf(x, y, z), normal, point, found);
  if (found.distance_m < kNewPlace * reach_m_) return found;
  for (std::int64_t dx = -1; dx <= 1; ++dx) {
    for (std::int64_t dy = -1; dy <= 1; ++dy) {
      for (std::int64_t dz = -1; dz <= 1; ++dz) {
        searchCell(keyOf(x + dx, y + dy, z + dz), normal, point, found);
      }
    }
  }
  return found;
}

int SurfaceRegister::surfaceOf(const Vec3& normal, const Vec3& point) {
  Found found = nearest(normal, point);
  if (found.surface >= 0 && found.distance_m < kNewPlace * reach_m_) return found.surface;
  if (found.surface < 0) {
    found.surface = size();
    normals_.push_back(normal);
  }
  const auto [x, y, z] = cellOf(point);
  cells_[keyOf(x, y, z)].push_back({point, found.surface});
  return found.surface;
}

}  // namespace paloc

#include "map_coverage.h"
#include "point_vector.h"

#include <cmath>
#include <numbers>

namespace paloc {
namespace {

constexpr double kDeepest_m = 3, kStep_m = 0.2, kAside_m = 0.3;
constexpr double kBeside_m = 0.15;
constexpr double kLevel = 0.7;     // cosine: what is flatter is ground
constexpr double kAligned = 0.95;  // of normals of one plane
constexpr double kOffPlane_m = 0.08;
constexpr double kReaches_m[] = {0.25, 0.5, 0.75, 1.0};  // over a shadow of the survey
constexpr int kDirections = 8;

Vec3 normalOf(const MapPlane& plane) {
  return {static_cast<double>(plane.nx), static_cast<double>(plane.ny),
          static_cast<double>(plane.nz)};
}

}  // namespace

bool MapCoverage::hasGroundBelow(const Vec3& p) const {
  for (double depth_m = 0; depth_m <= kDeepest_m; depth_m += kStep_m) {
    const PriorMap::Nearest nearest =
        map_.nearest(toPoint(p - depth_m * up_), static_cast<float>(kAside_m));
    if (!nearest.found()) continue;
    const MapPlane plane = map_.plane(nearest.index);
    const double below_m = up_.dot(p - toVec(map_.point(nearest.index)));
    if (plane.planar() && below_m > 0 && std::abs(normalOf(plane).dot(up_)) > kLevel) return true;
  }
  return false;
}

bool MapCoverage::continuesPlane(const RayTarget& target) const {
  if (!target.planar()) return false;
  const Vec3 normal = target.normal(), p = target.position();
  const Vec3 u = normal.unitOrthogonal(), v = normal.cross(u);
  for (const double reach_m : kReaches_m) {
    for (int i = 0; i < kDirections; ++i) {
      const double angle = 2 * std::numbers::pi * i / kDirections;
      const Vec3 at = p + reach_m * (std::cos(angle) * u + std::sin(angle) * v);
      const PriorMap::Nearest nearest = map_.nearest(toPoint(at), static_cast<float>(kBeside_m));
      if (!nearest.found()) continue;
      const MapPlane plane = map_.plane(nearest.index);
      if (!plane.planar() || std::abs(normalOf(plane).dot(normal)) < kAligned) continue;
      const double off_m = normalOf(plane).dot(p - toVec(map_.point(nearest.index))) -
                           static_cast<double>(plane.offset_m);
      if (std::abs(off_m) < kOffPlane_m) return true;
    }
  }
  return false;
}

}  // namespace paloc

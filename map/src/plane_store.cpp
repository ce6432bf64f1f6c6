#include "plane_store.h"

#include <algorithm>
#include <cmath>

namespace paloc {
namespace {

constexpr float kNormalUnit = 1.0F / 32767, kThicknessUnitM = 2e-5F, kSigmaUnitRad = 5e-6F;
constexpr std::uint32_t kMostPoints = 127;

std::int16_t packedNormal(float component) {
  return static_cast<std::int16_t>(std::lround(component / kNormalUnit));
}

// Rounded up: no plane becomes better than it is, and none vanishes.
std::uint16_t packed(float value, float unit) {
  return static_cast<std::uint16_t>(std::min(std::ceil(value / unit), 65534.0F));
}

}  // namespace

PackedPlane::PackedPlane(const MapPlane& plane)
    : offset_m_(plane.offset_m),
      nx_(packedNormal(plane.nx)),
      ny_(packedNormal(plane.ny)),
      nz_(packedNormal(plane.nz)),
      thickness_(plane.planar() ? packed(plane.thickness_m, kThicknessUnitM) : kNotPlanar),
      normal_sigma_(packed(plane.normal_sigma_rad, kSigmaUnitRad)),
      points_(static_cast<std::uint8_t>(std::min(plane.points, kMostPoints))),
      oriented_(plane.oriented ? 1 : 0) {}

Eigen::Vector3f PackedPlane::normal() const {
  return Eigen::Vector3f(static_cast<float>(nx_), static_cast<float>(ny_), static_cast<float>(nz_))
      .normalized();
}

MapPlane PackedPlane::unpacked() const {
  MapPlane plane;
  plane.thickness_m = -1;
  if (!planar()) return plane;
  const Eigen::Vector3f n = normal();
  plane.nx = n.x(), plane.ny = n.y(), plane.nz = n.z();
  plane.offset_m = offset_m_;
  plane.thickness_m = static_cast<float>(thickness_) * kThicknessUnitM;
  plane.normal_sigma_rad = static_cast<float>(normal_sigma_) * kSigmaUnitRad;
  plane.points = points_;
  plane.oriented = oriented();
  return plane;
}

void PackedPlane::orient(bool turn) {
  oriented_ = 1;
  if (!turn) return;
  nx_ = static_cast<std::int16_t>(-nx_);
  ny_ = static_cast<std::int16_t>(-ny_);
  nz_ = static_cast<std::int16_t>(-nz_);
  offset_m_ = -offset_m_;
}

}  // namespace paloc

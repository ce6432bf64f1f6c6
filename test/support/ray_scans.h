#pragma once

#include <vector>

#include "paloc/map/scan_rays.h"
#include "simulated_rooms.h"

/// Scans of simulated rooms as rays, for tests of occupancy and changes.
namespace paloc::test {

/// Rays in the map frame that are simply there.
class RayScans : public ScanRaySource {
 public:
  explicit RayScans(const Vec3& origin = Vec3::Zero()) : origin_(origin) {}

  std::size_t size() const override { return scans_.size(); }
  Vec3 origin() const override { return origin_; }
  ScanRays rays(std::size_t index) const override { return scans_[index]; }
  void add(ScanRays scan) { scans_.push_back(std::move(scan)); }
  ScanRays& back() { return scans_.back(); }

 private:
  Vec3 origin_;
  std::vector<ScanRays> scans_;
};

inline Point3f toPoint(const Vec3& p) {
  const Eigen::Vector3f f = p.cast<float>();
  return {f.x(), f.y(), f.z()};
}

/// A scan of a world from a pose, relative to `origin` (map frame).
inline ScanRays raysOf(const BoxWorld& world, const Pose& T_map_body, TimeNs t_ns, unsigned seed,
                       int count = 4000, const Vec3& origin = Vec3::Zero()) {
  const Scan scan = simulateScan(world, T_map_body, count, {0.01, 0, 0}, 50, seed);
  ScanRays rays;
  rays.t_ns = t_ns;
  for (const Point3f& p : scan.points_body) {
    const Vec3 body(static_cast<double>(p.x), static_cast<double>(p.y), static_cast<double>(p.z));
    rays.from.push_back(toPoint(T_map_body.position - origin));
    rays.to.push_back(toPoint(T_map_body * body - origin));
  }
  rays.position_sigma_m = 0.003;
  rays.rotation_sigma_rad = 0.0005;
  return rays;
}

/// Scans along a line through a world, one every half a second.
inline RayScans walkThrough(const BoxWorld& world, const Vec3& from, const Vec3& to, int scans,
                            TimeNs start_ns = 0) {
  RayScans all;
  for (int i = 0; i < scans; ++i) {
    const Vec3 at = from + (static_cast<double>(i) / (scans - 1)) * (to - from);
    all.add(raysOf(world, {at, so3::exp(Vec3(0, 0, 0.3 * i))}, start_ns + i * kNsPerSecond / 2,
                   static_cast<unsigned>(i + 1)));
  }
  return all;
}

}  // namespace paloc::test

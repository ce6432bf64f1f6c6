#pragma once

#include <cstddef>
#include <vector>

#include "paloc/core/trajectory.h"
#include "paloc/map/scan_rays.h"
#include "paloc/tools/scan_map.h"

namespace paloc {

/// The kept scans of a replay as rays, placed by its trajectory. Those without a usable pose stay
/// out. Refers to both.
class PlacedScans : public ScanRaySource {
 public:
  /// `origin` (m, in the map frame): what the rays are relative to.
  PlacedScans(const ScanMap& scans, const std::vector<TrajectoryPoint>& trajectory,
              const Vec3& origin);

  std::size_t size() const override { return placed_.size(); }
  Vec3 origin() const override { return origin_; }
  ScanRays rays(std::size_t index) const override;

 private:
  struct Placed {
    const ScanMap::ThinScan* scan;
    const TrajectoryPoint* at;
  };
  std::vector<Placed> placed_;
  Vec3 origin_;
};

}  // namespace paloc

#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>

#include "paloc/core/export.h"
#include "paloc/core/types.h"
#include "paloc/map/occupancy_settings.h"
#include "paloc/map/scan_rays.h"

namespace paloc {

/// Which cells of space are free and which are occupied, as the rays of scans tell: the log-odds of
/// A. Hornung et al., "OctoMap: An Efficient Probabilistic 3D Mapping Framework Based on Octrees"
/// (2013), in an octree of the library octomap with its own sensor model (hit 0.7, miss 0.4).
/// Within one scan a cell counts once, and as occupied if any ray ends in it.
class PALOC_EXPORT OccupancyMap {
 public:
  enum class State { kUnknown, kFree, kOccupied };

  /// `rays_origin`: ScanRaySource::origin() of the scans to come (m, in the map frame).
  OccupancyMap(const OccupancySettings& settings, const Vec3& rays_origin);
  ~OccupancyMap();
  OccupancyMap(const OccupancyMap&) = delete;
  OccupancyMap& operator=(const OccupancyMap&) = delete;

  /// Puts in a scan; false if the octree has reached its memory and the scan was left out.
  bool insert(const ScanRays& scan);

  /// Origin of the octree's frame (m, in the map frame). Zero, so that it is the map's frame,
  /// wherever the octree's 2^16 cells reach that far; else a round place near the scans.
  const Vec3& origin() const;
  State at(const Vec3& p_map) const;
  std::size_t scans() const;        ///< put in
  std::size_t cells() const;        ///< known leaves, after pruning
  std::size_t raysOutside() const;  ///< left out: beyond what the octree can hold
  double memoryMb() const;          ///< of the octree, estimated

  /// Writes a .bt. Each cell is rounded to surely free or surely occupied for that, here as well:
  /// it ends the map. Throws IoError.
  void save(const std::filesystem::path& file);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace paloc

#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "paloc/core/export.h"
#include "paloc/map/change_settings.h"
#include "paloc/map/point_cloud.h"
#include "paloc/map/prior_map.h"
#include "paloc/map/scan_rays.h"

namespace paloc {

/// What a point tells about the place; the numbers stand in map_changes.ply.
enum class MapChange : std::uint8_t {
  kGone = 1,      ///< of the prior map: several scans see through it
  kAdded = 2,     ///< of the scans: stood there all the time, in the midst of what the map shows
  kMoved = 3,     ///< of the scans: was there, and was seen not to be there at another time
  kUnmapped = 4,  ///< of the scans: the map shows nothing there, nor what is about it
};

inline constexpr MapChange kAllMapChanges[] = {MapChange::kGone, MapChange::kAdded,
                                               MapChange::kMoved, MapChange::kUnmapped};

/// One word ("gone").
PALOC_EXPORT std::string toString(MapChange change);

/// Points that differ, each with its kind.
struct MapChanges {
  PointCloud cloud;                 ///< gone: points of the prior map; else a point per 5 cm
  std::vector<MapChange> kinds;     ///< one per point
  std::size_t map_points_seen = 0;  ///< of the prior map: seen, or seen through, by any scan
  std::size_t scans_used = 0;
  std::size_t scans_unsure = 0;  ///< not used: their poses are too unsure
  PALOC_EXPORT std::size_t count(MapChange kind) const;
};

/// Measurement noise that decides what is beyond it (m, one sigma).
struct ChangeNoise {
  double range_m = 0.02;  ///< of a return's range
  double map_m = 0.005;   ///< of a map point about its surface
};

/// Finds what has changed, by what rays pass through: in the spirit of J. Schauer and A. Nuechter,
/// "The Peopleremover: Removing Dynamic Objects From 3-D Point Cloud Data by Traversing a Voxel
/// Occupancy Grid" (2018), and G. Kim and A. Kim, "Remove, then Revert: Static Point Cloud Map
/// Construction using Multiresolution Range Images" (2020).
/// A point is seen through by a scan when a ray crosses its surface (not grazing it) and ends well
/// behind, beyond all noise of range, map and pose, and no ray of that scan ends on it. Scans vote,
/// and neighbours on the same surface together. Points hidden behind something get no vote.
/// `scans` must have the map's origin. The same on any number of threads.
PALOC_EXPORT MapChanges findChanges(const PriorMap& map, const ScanRaySource& scans,
                                    const Vec3& up_map, const ChangeSettings& settings,
                                    const ChangeNoise& noise, int threads);

/// Writes a binary PLY: x, y, z (float, or double where the origin is not zero), `uchar change`
/// (MapChange) and red, green, blue. Throws IoError.
PALOC_EXPORT void saveChanges(const std::filesystem::path& file, const MapChanges& changes);

/// Reads what saveChanges wrote (points and kinds). Throws IoError for anything else.
PALOC_EXPORT MapChanges loadChanges(const std::filesystem::path& file);

}  // namespace paloc

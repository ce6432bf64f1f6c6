#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "paloc/core/types.h"
#include "paloc/map/map_settings.h"

namespace paloc {

/// What a map file holds, and what becomes of it as a prior map.
struct MapInfo {
  std::string file;
  std::string format;       ///< "PLY, binary_little_endian"
  std::uint64_t bytes = 0;  ///< of the file
  std::size_t points = 0;   ///< that are finite
  std::size_t nonfinite = 0;
  Vec3 low = Vec3::Zero(), high = Vec3::Zero();  ///< bounding box in the map frame (m)
  Vec3 origin = Vec3::Zero();  ///< that coordinates are stored relative to in memory (m)
  double spacing_m = 0;        ///< median distance of a point to the next
  bool intensity = false;
  std::size_t map_points = 0;  ///< left after thinning to map.voxel_m
  double planar_share = 0;     ///< of these, lying on a plane
  double load_s = 0;           ///< reading, thinning, search tree, planes of a sample
  double memory_mb = 0;        ///< of the map, ready to be matched against
  double peak_rss_mb = 0;      ///< of the process while it was loaded
};

/// Called now and then with the share of the file that is read, 0..1, and what for.
using MapInfoProgress = std::function<void(double share, const std::string& what)>;

/// Loads a prior map, and then reads the whole file. Throws IoError as these do.
MapInfo readMapInfo(const std::filesystem::path& file, const MapSettings& settings,
                    const MapInfoProgress& progress = {});

std::string tableOf(const MapInfo& info);
nlohmann::ordered_json jsonOf(const MapInfo& info);

}  // namespace paloc

#include "paloc/tools/place_changes.h"

#include <cstdio>
#include <nlohmann/json.hpp>

#include "paloc/core/text.h"
#include "paloc/tools/placed_scans.h"

namespace paloc {
namespace {

// The trajectory's own mean of it: the map may be tilted.
Vec3 upOf(const std::vector<TrajectoryPoint>& trajectory) {
  Vec3 down = Vec3::Zero();
  for (const TrajectoryPoint& point : trajectory) down += point.gravity_map;
  return down.norm() > 0 ? Vec3(-down.normalized()) : Vec3::UnitZ();
}

}  // namespace

PlaceChanges placeChanges(const PriorMap& map, const ScanMap& scans,
                          const std::vector<TrajectoryPoint>& trajectory, const Config& config,
                          StageTimer* timer) {
  const PlacedScans placed(scans, trajectory, map.origin());
  PlaceChanges place;
  place.occupancy = std::make_shared<OccupancyMap>(config.octomap, map.origin());
  for (std::size_t i = 0; i < placed.size(); ++i) {
    StageScope stage(timer, "octomap");
    place.scans_left_out += !place.occupancy->insert(placed.rays(i));
  }
  StageScope stage(timer, "changes");
  const ChangeNoise noise{config.matcher.range_noise_m, config.matcher.map_noise_m};
  place.changes =
      findChanges(map, placed, upOf(trajectory), config.changes, noise, config.matcher.threads);
  return place;
}

nlohmann::ordered_json octomapJson(const PlaceChanges& place) {
  const OccupancyMap& map = *place.occupancy;
  const Vec3& origin = map.origin();
  return {{"scans", map.scans()},
          {"scans_left_out", place.scans_left_out},
          {"rays_outside", map.raysOutside()},
          {"cells", map.cells()},
          {"memory_mb", map.memoryMb()},
          {"origin_map_m", {origin.x(), origin.y(), origin.z()}}};
}

nlohmann::ordered_json changesJson(const MapChanges& changes) {
  nlohmann::ordered_json json;
  for (const MapChange kind : kAllMapChanges) json[toString(kind)] = changes.count(kind);
  json["map_points_seen"] = changes.map_points_seen;
  json["scans_used"] = changes.scans_used;
  json["scans_unsure"] = changes.scans_unsure;
  return json;
}

std::string changesSentence(const MapChanges& changes) {
  std::string line;
  for (const MapChange kind : kAllMapChanges) {
    line += text(line.empty() ? "" : ", ", changes.count(kind), ' ', toString(kind));
  }
  return text(line, " points (", changes.map_points_seen, " map points seen by ",
              changes.scans_used, " scans)");
}

}  // namespace paloc

#pragma once

#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "paloc/config/config.h"
#include "paloc/core/stage_timer.h"
#include "paloc/core/trajectory.h"
#include "paloc/map/map_changes.h"
#include "paloc/map/occupancy_map.h"
#include "paloc/map/prior_map.h"
#include "paloc/tools/scan_map.h"

namespace paloc {

/// What the scans of a replay tell of the place: which space is free and occupied, and what differs
/// from the prior map.
struct PlaceChanges {
  std::shared_ptr<OccupancyMap> occupancy;
  std::size_t scans_left_out = 0;  ///< of the occupancy, for want of the memory allowed
  MapChanges changes;
};

/// Stages "octomap" (a call per scan) and "changes". The same on any number of threads.
PlaceChanges placeChanges(const PriorMap& map, const ScanMap& scans,
                          const std::vector<TrajectoryPoint>& trajectory, const Config& config,
                          StageTimer* timer);

/// For summary.json.
nlohmann::ordered_json octomapJson(const PlaceChanges& place);
nlohmann::ordered_json changesJson(const MapChanges& changes);
/// One line.
std::string changesSentence(const MapChanges& changes);

}  // namespace paloc

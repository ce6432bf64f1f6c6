#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "paloc/map/map_settings.h"
#include "paloc/map/matcher_settings.h"

namespace paloc {

struct BenchStartSettings {
  std::string scene = "building";  ///< of synth::sceneNames(): where starts are to be found
  std::string sensor = "os1-128";
  std::size_t places = 200;  ///< in it, of each kind of start
  std::size_t partial =
      100;                   ///< places in maps of which about half of what a scan shows is missing
  std::size_t wrong = 1000;  ///< starts in maps of other places; 0: none
  std::size_t storeys = 500;  ///< starts in maps of other storeys of the building
  std::uint64_t seed = 1;
  double map_spacing_m = 0.05;  ///< of the survey
  double survey_step_deg = 0.25;
  MapSettings map;
  MatcherSettings matcher;  ///< the range noise is replaced by the sensor's data sheet's
  std::string list_file;    ///< CSV with a row per start; empty: none
};

/// The map that a scan is looked for in.
enum class BenchStartMap {
  kRight,
  kPart,    ///< the right one, of which a half is missing, cut through where the scan was taken
  kWrong,   ///< of another place
  kStorey,  ///< of another storey: the same walls, other furniture
};

/// One row of the table: starts of one kind in one kind of map.
struct BenchStartRow {
  std::string kind;
  BenchStartMap map = BenchStartMap::kRight;
  std::size_t starts = 0;
  std::size_t found = 0;     ///< accepted, within 10 cm and 1 degree of the truth
  std::size_t accepted = 0;  ///< of a wrong map, or further from the truth than that: false
  std::map<std::string, std::size_t> refused{};  ///< by reason
  std::vector<double> locate_ms{};
};

std::string nameOf(BenchStartMap map);

using BenchStartProgress = std::function<void(const std::string& what, double share)>;

/// Looks for scans at random poses in a survey of their scene, and in a part of it, from worse and
/// worse guesses; for scans of every scene in the map of every other, where none must be found
/// (among the scenes is the mirror image of `building`: the same rooms, in no place the same); and
/// for scans of storeys of the building in the maps of others, from where they would be right.
/// Throws UsageError for unknown names.
std::vector<BenchStartRow> benchStart(const BenchStartSettings& settings,
                                      const BenchStartProgress& progress);

std::string tableOf(const std::vector<BenchStartRow>& rows);
nlohmann::ordered_json jsonOf(const std::vector<BenchStartRow>& rows);

}  // namespace paloc

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
  std::size_t wrong = 1000;  ///< starts in wrong maps; 0: none
  std::uint64_t seed = 1;
  double map_spacing_m = 0.05;  ///< of the survey
  double survey_step_deg = 0.25;
  MapSettings map;
  MatcherSettings matcher;  ///< the range noise is replaced by the sensor's data sheet's
  std::string list_file;    ///< CSV with a row per start; empty: none
};

/// One row of the table: starts of one kind, in the right map or in wrong ones.
struct BenchStartRow {
  std::string kind;
  bool wrong_map = false;
  std::size_t starts = 0;
  std::size_t found = 0;     ///< accepted, within 10 cm and 1 degree of the truth
  std::size_t accepted = 0;  ///< of a wrong map, or further from the truth than that: false
  std::map<std::string, std::size_t> refused;  ///< by reason
  std::vector<double> locate_ms;
};

using BenchStartProgress = std::function<void(const std::string& what, double share)>;

/// Looks for scans at random poses in a survey of their scene, from worse and worse guesses; and
/// for scans of every scene in the map of every other, where none must be found. Among the scenes
/// is the mirror image of `building`: the same rooms, in no place the same. Throws UsageError for
/// unknown names.
std::vector<BenchStartRow> benchStart(const BenchStartSettings& settings,
                                      const BenchStartProgress& progress);

std::string tableOf(const std::vector<BenchStartRow>& rows);
nlohmann::ordered_json jsonOf(const std::vector<BenchStartRow>& rows);

}  // namespace paloc

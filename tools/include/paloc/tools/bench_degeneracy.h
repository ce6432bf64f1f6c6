#pragma once

#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "paloc/map/map_settings.h"
#include "paloc/map/matcher_settings.h"
#include "paloc/tools/degeneracy_score.h"

namespace paloc {

struct BenchDegeneracySettings {
  std::vector<std::string> scenes;   ///< of synth::sceneNames(); empty: all
  std::vector<std::string> sensors;  ///< of synth::sensorNames(); empty: all
  std::size_t poses = 50;            ///< of each scene and sensor
  std::uint64_t seed = 1;
  double map_spacing_m = 0.025;  ///< of the survey
  double survey_step_deg = 0.2;
  MapSettings map;
  MatcherSettings matcher;  ///< the range noise is replaced by the sensor's data sheet's
  std::string list_file;    ///< CSV with a row per direction; empty: none
};

/// One row of the table.
struct BenchDegeneracyRow {
  std::string scene, sensor;
  DegeneracyScore score;
  std::vector<double> directions_ms;  ///< of information and directions, a match each
};

using BenchDegeneracyProgress = std::function<void(const std::string& scene_and_sensor)>;

/// Classes directions at random poses along the scenes' routes (0.3 m aside, 0.2 m up and down,
/// any heading, tilted by up to some 10 degrees) against labels of the exact geometry
/// (degeneracy_labels.h). The map is a survey of the scene with its noise, the scan has the
/// sensor's, and the registration starts 5 cm and half a degree off. Throws UsageError for unknown
/// names.
std::vector<BenchDegeneracyRow> benchDegeneracy(const BenchDegeneracySettings& settings,
                                                const BenchDegeneracyProgress& progress);

/// The rows as a table for people, with their sum in the last line.
std::string tableOf(const std::vector<BenchDegeneracyRow>& rows);
nlohmann::ordered_json jsonOf(const std::vector<BenchDegeneracyRow>& rows);

}  // namespace paloc

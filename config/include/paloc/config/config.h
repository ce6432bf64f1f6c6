#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "paloc/core/estimator_settings.h"
#include "paloc/core/export.h"
#include "paloc/frontends/frontend_settings.h"
#include "paloc/map/change_settings.h"
#include "paloc/map/map_settings.h"
#include "paloc/map/matcher_settings.h"
#include "paloc/map/occupancy_settings.h"

namespace paloc {

/// All settings of paloc. Each module owns its struct and the defaults in it; units stand at the
/// end of the names. What may be set from a file is listed in settings.h, one row per field.
struct Config {
  FrontendSettings frontend;
  MapSettings map;
  MatcherSettings matcher;
  OccupancySettings octomap;
  ChangeSettings changes;
  EstimatorSettings estimator;  ///< its parts `imu` and `smoother` are sections of their own
};

/// The settings of the front-ends, with the IMU's noise and the gravity that they share with the
/// estimator.
PALOC_EXPORT FrontendSettings frontendSettingsOf(const Config& config);

/// Reads a YAML file over the defaults. Strict: throws ConfigError ("file:line: key: what is
/// wrong") on an unknown key (with the nearest known one), a key given twice, a value of the wrong
/// type or out of its range, settings that contradict each other, and a file that cannot be read.
PALOC_EXPORT Config loadConfig(const std::filesystem::path& file);

/// The same from text; `name` stands for the file in errors.
PALOC_EXPORT Config parseConfig(std::string_view text, const std::string& name);

/// Reads a YAML file over a configuration that is there already, for files that build on each other
/// (a sensor, then a site). On an error `config` is left as it was.
PALOC_EXPORT void overlayConfig(Config& config, const std::filesystem::path& file);

/// Sets one value from "key=value" (`matcher.fine_distance_m=0.2`), as the command line has it. A
/// string needs no quotes. Throws ConfigError; then `config` is left as it was.
PALOC_EXPORT void setValue(Config& config, std::string_view assignment);

/// Throws ConfigError if a value is out of its range or two contradict each other: for a
/// configuration that was filled in by a program.
PALOC_EXPORT void checkConfig(const Config& config);

/// All settings as YAML, with unit, range and meaning of each as comments. Numbers are the shortest
/// that read back to the same bits; the same configuration gives the same bytes.
PALOC_EXPORT std::string dumpConfig(const Config& config);

}  // namespace paloc

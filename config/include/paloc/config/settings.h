#pragma once

#include <functional>
#include <string>
#include <variant>
#include <vector>

#include "paloc/config/config.h"
#include "paloc/core/export.h"

namespace paloc {

/// The types a setting can have. A choice among names is a string with `choices`.
using SettingValue = std::variant<bool, int, double, std::string>;

/// One row of the table of settings: loading, dumping, checking and describing all go by it.
struct Setting {
  std::string key;                   ///< dotted: "matcher.fine_distance_m"
  std::string unit;                  ///< "m"; empty where there is none
  double min = 0, max = 0;           ///< numbers: both ends are allowed
  std::vector<std::string> choices;  ///< strings: the only ones allowed, or empty for any
  std::string sentence;              ///< what it is
  std::function<SettingValue(const Config&)> get;
  std::function<void(Config&, const SettingValue&)> set;
};

/// All settings, section by section, in the order of the dump.
PALOC_EXPORT const std::vector<Setting>& allSettings();

/// "bool", "int", "double" or "string".
PALOC_EXPORT std::string typeName(const Setting& setting);

/// A value as YAML: numbers in the shortest form that reads back to the same bits, strings quoted.
PALOC_EXPORT std::string formatValue(const SettingValue& value);

/// "m, 0.01 to 10" or "one of recorded, icp"; empty if anything goes.
PALOC_EXPORT std::string describeRange(const Setting& setting);

/// The table for a reader: key, default, unit and range, sentence.
PALOC_EXPORT std::string describeSettings();

}  // namespace paloc

#pragma once

#include <string>
#include <string_view>

#include "paloc/config/settings.h"

namespace paloc {

/// Reads a value of the setting's type from `text`, the whole of it and nothing but it, and checks
/// its range. Throws ConfigError without the place: "expects a number, not '1.5m'".
SettingValue parseValue(const Setting& setting, std::string_view text);

/// Throws ConfigError, likewise without the place, if the value is out of the setting's range.
void checkRange(const Setting& setting, const SettingValue& value);

/// The row of a key, or null.
const Setting* findSetting(std::string_view key);

/// "unknown key; did you mean 'x.y'?", with the known key that looks most alike.
std::string unknownKeySentence(std::string_view key);

/// What two settings together get wrong.
struct Contradiction {
  std::string key;  ///< the one to change; empty if there is none
  std::string sentence;
};
Contradiction findContradiction(const Config& config);

}  // namespace paloc

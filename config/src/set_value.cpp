#include <algorithm>

#include "paloc/core/errors.h"
#include "value.h"

namespace paloc {

void setValue(Config& config, std::string_view assignment) {
  const auto equals = assignment.find('=');
  if (equals == std::string_view::npos) {
    throw ConfigError("--set " + std::string(assignment) + ": expects key=value");
  }
  const std::string key(assignment.substr(0, equals));
  const auto fail = [&](const std::string& sentence) {
    throw ConfigError("--set " + key + ": " + sentence);
  };
  const Setting* setting = findSetting(key);
  if (setting == nullptr) return fail(unknownKeySentence(key));
  try {
    setting->set(config, parseValue(*setting, assignment.substr(equals + 1)));
  } catch (const ConfigError& e) {
    fail(e.what());
  }
}

void checkConfig(const Config& config) {
  for (const Setting& setting : allSettings()) {
    try {
      checkRange(setting, setting.get(config));
    } catch (const ConfigError& e) {
      throw ConfigError(setting.key + ": " + e.what());
    }
  }
  const Contradiction wrong = findContradiction(config);
  if (!wrong.key.empty()) throw ConfigError(wrong.key + ": " + wrong.sentence);
}

}  // namespace paloc

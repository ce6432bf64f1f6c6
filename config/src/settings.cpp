#include "paloc/config/settings.h"

#include <array>
#include <charconv>
#include <sstream>

#include "section.h"

namespace paloc {
namespace {

std::vector<Setting> buildTable() {
  std::vector<Setting> table;
  for (auto section : {frontendSettings, localMapSettings, fastLioSettings, icpSettings,
                       lioSamSettings, imuSettings, mapSettings, matcherSettings, smootherSettings,
                       stillnessSettings, estimatorSettings, occupancySettings, changeSettings}) {
    for (Setting& row : section()) table.push_back(std::move(row));
  }
  return table;
}

template <typename Number>
std::string shortest(Number number) {
  std::array<char, 32> buffer{};
  const auto end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), number).ptr;
  return {buffer.data(), end};
}

std::string quoted(const std::string& text) {
  std::ostringstream out;
  out << '"';
  for (const char c : text) {
    const auto code = static_cast<unsigned char>(c);
    if (c == '"' || c == '\\') {
      out << '\\' << c;
    } else if (code < 0x20 || code == 0x7f) {
      static constexpr char kHex[] = "0123456789abcdef";
      out << "\\x" << kHex[code / 16] << kHex[code % 16];
    } else {
      out << c;
    }
  }
  out << '"';
  return out.str();
}

struct Formatter {
  std::string operator()(bool value) const { return value ? "true" : "false"; }
  std::string operator()(int value) const { return shortest(value); }
  std::string operator()(double value) const { return shortest(value); }
  std::string operator()(const std::string& value) const { return quoted(value); }
};

}  // namespace

FrontendSettings frontendSettingsOf(const Config& config) {
  FrontendSettings settings = config.frontend;
  settings.imu_noise = config.estimator.imu;
  settings.gravity_mps2 = config.estimator.gravity_mps2;
  return settings;
}

const std::vector<Setting>& allSettings() {
  static const std::vector<Setting> table = buildTable();
  return table;
}

std::string typeName(const Setting& setting) {
  static constexpr std::array kNames = {"bool", "int", "double", "string"};
  return kNames.at(setting.get(Config{}).index());
}

std::string formatValue(const SettingValue& value) { return std::visit(Formatter{}, value); }

std::string describeRange(const Setting& setting) {
  std::string text;
  if (setting.min < setting.max) {
    text = shortest(setting.min) + " to " + shortest(setting.max);
    if (!setting.unit.empty()) text = setting.unit + ", " + text;
  }
  for (const std::string& choice : setting.choices) {
    text += (text.empty() ? "one of " : ", ") + choice;
  }
  return text;
}

std::string describeSettings() {
  std::ostringstream out;
  const Config defaults;
  for (const Setting& setting : allSettings()) {
    out << setting.key << " = " << formatValue(setting.get(defaults)) << "\n    "
        << setting.sentence;
    const std::string range = describeRange(setting);
    if (!range.empty()) out << " [" << range << ']';
    out << '\n';
  }
  return out.str();
}

}  // namespace paloc

#include "value.h"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "paloc/core/errors.h"

namespace paloc {
namespace {

[[noreturn]] void refuse(const std::string& expected, std::string_view text) {
  throw ConfigError("expects " + expected + ", not '" + std::string(text) + "'");
}

// from_chars knows no locale and takes no part of a number: unlike stod, "1,5" and "1.5m" fail.
template <typename Number>
Number parseNumber(std::string_view text, const char* expected) {
  std::string_view digits = text;
  if (digits.size() > 1 && digits[0] == '+' && digits[1] != '-') digits.remove_prefix(1);
  Number number{};
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), number);
  if (error == std::errc::result_out_of_range) refuse("a number of ordinary size", text);
  if (error != std::errc{} || end != digits.data() + digits.size()) refuse(expected, text);
  return number;
}

struct Parser {
  std::string_view text;
  SettingValue operator()(bool) const {
    if (text != "true" && text != "false") refuse("true or false", text);
    return text == "true";
  }
  SettingValue operator()(int) const { return parseNumber<int>(text, "a whole number"); }
  SettingValue operator()(double) const {
    const auto number = parseNumber<double>(text, "a number");
    if (!std::isfinite(number)) refuse("a finite number", text);
    return number;
  }
  SettingValue operator()(const std::string&) const { return std::string(text); }
};

struct RangeChecker {
  const Setting& setting;
  void operator()(bool) const {}
  void operator()(double number) const {
    // Written so that NaN fails.
    if (number >= setting.min && number <= setting.max) return;
    throw ConfigError(formatValue(number) + " is out of range: " + describeRange(setting));
  }
  void operator()(int number) const { (*this)(static_cast<double>(number)); }
  void operator()(const std::string& text) const {
    const auto& choices = setting.choices;
    if (choices.empty() || std::find(choices.begin(), choices.end(), text) != choices.end()) return;
    throw ConfigError("'" + text + "' is not " + describeRange(setting));
  }
};

}  // namespace

void checkRange(const Setting& setting, const SettingValue& value) {
  std::visit(RangeChecker{setting}, value);
}

SettingValue parseValue(const Setting& setting, std::string_view text) {
  SettingValue value = std::visit(Parser{text}, setting.get(Config{}));
  checkRange(setting, value);
  return value;
}

}  // namespace paloc

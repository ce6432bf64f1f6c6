#pragma once

#include <string>
#include <utility>
#include <vector>

#include "paloc/config/settings.h"

namespace paloc {

/// The ends of a number's range; both are allowed.
struct Range {
  double min = 0, max = 0;
};

/// Builds the rows of one section: `Struct` is the module's struct of settings, `member` its place
/// in the configuration.
template <typename Struct>
class Section {
 public:
  Section(std::string name, Struct Config::*member) : name_(std::move(name)), member_(member) {}

  void number(const char* key, double Struct::*field, const char* unit, Range range,
              const char* sentence) {
    add(key, field, unit, range, sentence);
  }
  void count(const char* key, int Struct::*field, Range range, const char* sentence) {
    add(key, field, "", range, sentence);
  }
  void flag(const char* key, bool Struct::*field, const char* sentence) {
    add(key, field, "", {}, sentence);
  }
  void text(const char* key, std::string Struct::*field, const char* sentence,
            std::vector<std::string> choices = {}) {
    add(key, field, "", {}, sentence);
    rows_.back().choices = std::move(choices);
  }

  std::vector<Setting> rows() && { return std::move(rows_); }

 private:
  template <typename T>
  void add(const char* key, T Struct::*field, const char* unit, Range range, const char* sentence) {
    Setting row;
    row.key = name_ + "." + key;
    row.unit = unit;
    row.min = range.min;
    row.max = range.max;
    row.sentence = sentence;
    row.get = [member = member_, field](const Config& c) { return SettingValue(c.*member.*field); };
    row.set = [member = member_, field](Config& c, const SettingValue& value) {
      c.*member.*field = std::get<T>(value);
    };
    rows_.push_back(std::move(row));
  }

  std::string name_;
  Struct Config::*member_;
  std::vector<Setting> rows_;
};

// One maker a section, each in its own file.
std::vector<Setting> frontendSettings();
std::vector<Setting> imuSettings();
std::vector<Setting> mapSettings();
std::vector<Setting> matcherSettings();

}  // namespace paloc

#pragma once

#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "paloc/config/settings.h"

namespace paloc {

/// The ends of a number's range; both are allowed.
struct Range {
  double min = 0, max = 0;
};

/// Builds the rows of one section. `place` takes a configuration, const or not, to the module's
/// struct of settings in it.
template <typename Place>
class Section {
 public:
  using Struct = std::remove_cvref_t<std::invoke_result_t<Place, Config&>>;

  Section(std::string name, Place place) : name_(std::move(name)), place_(place) {}

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
    row.key = name_;
    row.key += '.';
    row.key += key;
    row.unit = unit;
    row.min = range.min;
    row.max = range.max;
    row.sentence = sentence;
    row.get = [place = place_, field](const Config& c) { return SettingValue(place(c).*field); };
    row.set = [place = place_, field](Config& c, const SettingValue& value) {
      place(c).*field = std::get<T>(value);
    };
    rows_.push_back(std::move(row));
  }

  std::string name_;
  Place place_;
  std::vector<Setting> rows_;
};

// One maker a section, each in its own file.
std::vector<Setting> changeSettings();
std::vector<Setting> estimatorSettings();
std::vector<Setting> fastLioSettings();
std::vector<Setting> frontendSettings();
std::vector<Setting> icpSettings();
std::vector<Setting> imuSettings();
std::vector<Setting> lioSamSettings();
std::vector<Setting> localMapSettings();
std::vector<Setting> mapSettings();
std::vector<Setting> matcherSettings();
std::vector<Setting> occupancySettings();
std::vector<Setting> smootherSettings();
std::vector<Setting> stillnessSettings();

}  // namespace paloc

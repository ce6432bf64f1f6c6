#include <algorithm>
#include <limits>
#include <numeric>

#include "value.h"

namespace paloc {
namespace {

/// Levenshtein's distance: insertions, deletions and replacements that lead from `a` to `b`.
std::size_t editDistance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t replaced = diagonal + (a[i - 1] == b[j - 1] ? 0 : 1);
      diagonal = row[j];
      row[j] = std::min({row[j] + 1, row[j - 1] + 1, replaced});
    }
  }
  return row.back();
}

std::string_view lastPart(std::string_view key) {
  const auto dot = key.rfind('.');
  return dot == std::string_view::npos ? key : key.substr(dot + 1);
}

/// A name in the wrong section is one mistake, whatever the length of the section's name.
std::size_t keyDistance(std::string_view given, std::string_view known) {
  return std::min(editDistance(given, known), 1 + editDistance(lastPart(given), lastPart(known)));
}

}  // namespace

const Setting* findSetting(std::string_view key) {
  const auto& all = allSettings();
  const auto row =
      std::find_if(all.begin(), all.end(), [&](const Setting& s) { return s.key == key; });
  return row == all.end() ? nullptr : &*row;
}

std::string unknownKeySentence(std::string_view key) {
  std::string nearest;
  std::size_t least = std::numeric_limits<std::size_t>::max();
  for (const Setting& setting : allSettings()) {
    const std::size_t distance = keyDistance(key, setting.key);
    if (distance < least) {
      least = distance;
      nearest = setting.key;
    }
  }
  // Beyond half of the letters a suggestion would be a guess.
  if (least > std::max<std::size_t>(2, lastPart(key).size() / 2)) return "unknown key";
  return "unknown key; did you mean '" + nearest + "'?";
}

}  // namespace paloc

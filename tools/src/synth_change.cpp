#include "paloc/tools/synth_change.h"

#include <charconv>
#include <cmath>

#include "paloc/core/errors.h"
#include "paloc/core/text.h"

namespace paloc::synth {
namespace {

struct KindRow {
  ChangeKind kind;
  const char* name;
  std::size_t max_values;
};

constexpr KindRow kKinds[] = {
    {ChangeKind::kMovedWall, "moved-wall", 2},
    {ChangeKind::kRemovedFurniture, "removed-furniture", 1},
    {ChangeKind::kAddedBox, "added-box", 1},
    {ChangeKind::kWalkingPeople, "walking-people", 1},
    {ChangeKind::kGlass, "glass", 0},
    {ChangeKind::kMissingPart, "missing-part", 4},
};

constexpr double kLargestValue = 1000;  // m, or pieces

double parseValue(const std::string& change, std::string_view word) {
  double value = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (error != std::errc{} || end != word.data() + word.size() || !std::isfinite(value) ||
      std::abs(value) > kLargestValue) {
    throw UsageError(text("--change: '", word, "' in '", change, "' is not a number up to 1000"));
  }
  return value;
}

}  // namespace

std::string toString(ChangeKind kind) {
  for (const KindRow& row : kKinds) {
    if (row.kind == kind) return row.name;
  }
  return "unknown";
}

std::vector<std::string> changeNames() {
  std::vector<std::string> names;
  for (const KindRow& row : kKinds) names.emplace_back(row.name);
  return names;
}

Change parseChange(const std::string& change) {
  const std::size_t equals = change.find('=');
  const std::string name = change.substr(0, equals);
  std::string known;
  for (const KindRow& row : kKinds) {
    known += (known.empty() ? "" : ", ") + std::string(row.name);
    if (name != row.name) continue;
    Change result{row.kind, {}};
    if (equals == std::string::npos) return result;
    std::string_view rest = std::string_view(change).substr(equals + 1);
    for (std::size_t comma = 0; comma != std::string_view::npos;) {
      comma = rest.find(',');
      result.values.push_back(parseValue(change, rest.substr(0, comma)));
      if (comma != std::string_view::npos) rest.remove_prefix(comma + 1);
    }
    const std::size_t most = row.max_values;
    if (result.values.size() > most || (most == 4 && result.values.size() != most)) {
      throw UsageError(text("--change: '", change, "' has ", result.values.size(), " values; ",
                            name, " takes ", most == 4 ? "none or " : "at most ", most));
    }
    return result;
  }
  throw UsageError(text("--change: there is no change '", name, "'; there are: ", known));
}

}  // namespace paloc::synth

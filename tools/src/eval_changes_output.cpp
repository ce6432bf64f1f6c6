#include <cstdio>
#include <nlohmann/json.hpp>

#include "paloc/tools/eval_changes.h"

namespace paloc {
namespace {

using Json = nlohmann::ordered_json;

std::string percent(const std::optional<double>& share) {
  if (!share) return "-";
  char text[32];
  std::snprintf(text, sizeof text, "%.1f %%", 100 * *share);
  return text;
}

Json orNull(const std::optional<double>& share) { return share ? Json(*share) : Json(nullptr); }

}  // namespace

std::string tableOf(const EvalChangesResult& result) {
  char line[200];
  std::string out;
  std::snprintf(line, sizeof line, "%-10s %9s %9s %10s %9s %9s %9s\n", "points", "reported",
                "correct", "precision", "there", "found", "recall");
  out += line;
  for (const ChangeScore& s : result.kinds) {
    std::snprintf(line, sizeof line, "%-10s %9zu %9zu %10s %9zu %9zu %9s\n",
                  toString(s.kind).c_str(), s.reported, s.correct, percent(s.precision()).c_str(),
                  s.there, s.found, percent(s.recall()).c_str());
    out += line;
  }
  for (const ObjectScore& object : result.objects) {
    std::snprintf(line, sizeof line, "%-6s %-30s %zu of %zu\n", toString(object.kind).c_str(),
                  object.name.c_str(), object.found, object.there);
    out += line;
  }
  return out;
}

Json jsonOf(const EvalChangesResult& result) {
  Json json;
  for (const ChangeScore& s : result.kinds) {
    json[toString(s.kind)] = {
        {"reported", s.reported}, {"correct", s.correct}, {"precision", orNull(s.precision())},
        {"there", s.there},       {"found", s.found},     {"recall", orNull(s.recall())}};
  }
  json["objects"] = Json::array();
  for (const ObjectScore& object : result.objects) {
    json["objects"].push_back({{"name", object.name},
                               {"change", toString(object.kind)},
                               {"there", object.there},
                               {"found", object.found}});
  }
  return json;
}

}  // namespace paloc

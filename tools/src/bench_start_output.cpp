#include <cstdio>
#include <nlohmann/json.hpp>

#include "paloc/tools/bench_start.h"
#include "paloc/tools/quantile.h"

namespace paloc {
namespace {

std::string reasonsOf(const BenchStartRow& row) {
  std::string reasons;
  for (const auto& [reason, count] : row.refused) {
    reasons += (reasons.empty() ? "" : ", ") + std::to_string(count) + ' ' + reason;
  }
  return reasons;
}

}  // namespace

std::string tableOf(const std::vector<BenchStartRow>& rows) {
  std::string out =
      "map    known                  starts  found  false  refused  p50 ms  p99 ms  why refused\n";
  for (const BenchStartRow& row : rows) {
    char line[160];
    std::snprintf(line, sizeof line, "%-6s %-22s %6zu %6zu %6zu %8zu %7.0f %7.0f  ",
                  nameOf(row.map).c_str(), row.kind.c_str(), row.starts, row.found, row.accepted,
                  row.starts - row.found - row.accepted, quantile(row.locate_ms, 0.5),
                  quantile(row.locate_ms, 0.99));
    out += line + reasonsOf(row) + '\n';
  }
  return out;
}

nlohmann::ordered_json jsonOf(const std::vector<BenchStartRow>& rows) {
  nlohmann::ordered_json json;
  json["rows"] = nlohmann::ordered_json::array();
  for (const BenchStartRow& row : rows) {
    json["rows"].push_back(
        {{"map", nameOf(row.map)},
         {"known", row.kind},
         {"starts", row.starts},
         {"found", row.found},
         {"false", row.accepted},
         {"refused", row.refused},
         {"locate_ms",
          {{"p50", quantile(row.locate_ms, 0.5)}, {"p99", quantile(row.locate_ms, 0.99)}}}});
  }
  return json;
}

}  // namespace paloc

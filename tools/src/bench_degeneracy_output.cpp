#include <cstdio>
#include <nlohmann/json.hpp>

#include "paloc/tools/bench_degeneracy.h"
#include "paloc/tools/quantile.h"

namespace paloc {
namespace {

using Json = nlohmann::ordered_json;

std::string lineOf(const BenchDegeneracyRow& row) {
  const DegeneracyScore& s = row.score;
  char line[240];
  std::snprintf(line, sizeof line,
                "%-14s %-12s %5zu %4zu %6zu %6.3f %6.3f %6.3f %6.2f %6zu %5zu %6.2f %5zu %6.3f\n",
                row.scene.c_str(), row.sensor.c_str(), s.poses, s.refused, s.degenerate,
                s.precision(), s.recall(), s.f1(), quantile(s.axis_errors_deg, 0.95), s.full,
                s.false_alarms, 100 * s.falseAlarmRate(), s.weak, quantile(row.directions_ms, 0.5));
  return line;
}

BenchDegeneracyRow sumOf(const std::vector<BenchDegeneracyRow>& rows) {
  BenchDegeneracyRow sum;
  sum.scene = "all";
  for (const BenchDegeneracyRow& row : rows) {
    sum.score.merge(row.score);
    sum.directions_ms.insert(sum.directions_ms.end(), row.directions_ms.begin(),
                             row.directions_ms.end());
  }
  return sum;
}

Json jsonOf(const BenchDegeneracyRow& row) {
  const DegeneracyScore& s = row.score;
  return {
      {"scene", row.scene},
      {"sensor", row.sensor},
      {"poses", s.poses},
      {"refused", s.refused},
      {"degenerate", s.degenerate},
      {"found", s.found},
      {"called_partial", s.called_partial},
      {"precision", s.precision()},
      {"recall", s.recall()},
      {"f1", s.f1()},
      {"axis_error_deg",
       {{"p50", quantile(s.axis_errors_deg, 0.5)}, {"p95", quantile(s.axis_errors_deg, 0.95)}}},
      {"full", s.full},
      {"false_alarms", s.false_alarms},
      {"false_alarm_rate", s.falseAlarmRate()},
      {"weak", s.weak},
      {"weak_called_full", s.weak_called_full},
      {"directions_ms",
       {{"p50", quantile(row.directions_ms, 0.5)}, {"p99", quantile(row.directions_ms, 0.99)}}}};
}

}  // namespace

std::string tableOf(const std::vector<BenchDegeneracyRow>& rows) {
  std::string out =
      "                                  re-  degen- preci-               axis         false       "
      "           time\n"
      "scene          sensor       poses fused erate  sion  recall     F1   p95 deg  full alarms   "
      " "
      "%%  weak    ms\n";
  for (const BenchDegeneracyRow& row : rows) out += lineOf(row);
  return out + lineOf(sumOf(rows));
}

Json jsonOf(const std::vector<BenchDegeneracyRow>& rows) {
  Json json;
  json["rows"] = Json::array();
  for (const BenchDegeneracyRow& row : rows) json["rows"].push_back(jsonOf(row));
  json["all"] = jsonOf(sumOf(rows));
  return json;
}

}  // namespace paloc

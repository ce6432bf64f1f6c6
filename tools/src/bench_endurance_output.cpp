#include <cinttypes>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "paloc/tools/bench_endurance.h"

namespace paloc {

std::string tableOf(const BenchEnduranceResult& result) {
  std::string out =
      "   updates   p50 ms   p99 ms   resident MB   newest, RMSE mm   NEES/dof of its pose\n";
  char line[160];
  for (const EnduranceStretch& s : result.stretches) {
    std::snprintf(line, sizeof line, "%10zu %8.4f %8.4f %13.1f %17.2f %22.3f\n", s.updates,
                  s.p50_ms, s.p99_ms, s.resident_mb, 1e3 * s.position_rmse_m, s.nees_per_dof);
    out += line;
  }
  const RepairCounts& repairs = result.repairs;
  std::snprintf(
      line, sizeof line,
      "\nlag %g s, %.1f s in all; repairs: %zu damped, %zu factors dropped, %zu re-anchored; "
      "refused as too old: %" PRIu64 "\n",
      result.lag_s, result.wall_s, static_cast<std::size_t>(repairs.damped),
      static_cast<std::size_t>(repairs.factors_dropped),
      static_cast<std::size_t>(repairs.reanchored), result.refused_as_too_old);
  return out + line;
}

nlohmann::ordered_json jsonOf(const BenchEnduranceResult& result) {
  nlohmann::ordered_json json;
  json["lag_s"] = result.lag_s;
  json["wall_s"] = result.wall_s;
  json["stretches"] = nlohmann::ordered_json::array();
  for (const EnduranceStretch& s : result.stretches) {
    json["stretches"].push_back({{"updates", s.updates},
                                 {"update_cpu_ms", {{"p50", s.p50_ms}, {"p99", s.p99_ms}}},
                                 {"resident_mb", s.resident_mb},
                                 {"newest_position_rmse_m", s.position_rmse_m},
                                 {"newest_pose_nees_per_dof", s.nees_per_dof}});
  }
  json["repairs"] = {{"damped", result.repairs.damped},
                     {"factors_dropped", result.repairs.factors_dropped},
                     {"reanchored", result.repairs.reanchored}};
  json["refused_as_too_old"] = result.refused_as_too_old;
  return json;
}

}  // namespace paloc

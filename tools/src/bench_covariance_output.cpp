#include <cstdio>
#include <nlohmann/json.hpp>

#include "paloc/tools/bench_covariance.h"
#include "paloc/tools/eval_covariance.h"
#include "paloc/tools/quantile.h"

namespace paloc {

std::string tableOf(const BenchCovarianceResult& result) {
  std::string out;
  for (const auto& [name, place] : result.places) {
    char line[200];
    std::snprintf(
        line, sizeof line,
        "%s: %zu trajectories, NEES/dof of a trajectory %.2f at the median, %.2f at most; "
        "%zu without a trajectory, %zu unusable covariances\n",
        name.c_str(), place.nees_per_seed.size(), quantile(place.nees_per_seed, 0.5),
        quantile(place.nees_per_seed, 1), place.failed, place.unusable);
    out += line + tableOf(place.by_flag, place.all) + '\n';
  }
  return out;
}

nlohmann::ordered_json jsonOf(const BenchCovarianceResult& result) {
  nlohmann::ordered_json json = nlohmann::ordered_json::object();
  for (const auto& [name, place] : result.places) {
    nlohmann::ordered_json& row = json[name];
    row["all"] = jsonOf(place.all);
    row["by_flag"] = nlohmann::ordered_json::object();
    for (const auto& [flag, errors] : place.by_flag) row["by_flag"][flag] = jsonOf(errors);
    row["nees_per_dof_of_each_seed"] = place.nees_per_seed;
    row["without_trajectory"] = place.failed;
    row["unusable_covariances"] = place.unusable;
  }
  return json;
}

}  // namespace paloc

#include <cstdio>
#include <nlohmann/json.hpp>

#include "paloc/tools/eval_covariance.h"

namespace paloc {
namespace {

using Json = nlohmann::ordered_json;

std::string rowOf(const std::string& name, const NormalizedErrors& e) {
  char line[200];
  std::snprintf(line, sizeof line,
                "%-19s %7zu %7.2f %9.2f %9.2f %7.2f %8.1f %% %8.2f %9.2f %8.2f %9.3f %9.3f\n",
                name.c_str(), e.poses, e.pose, e.position, e.rotation, e.pose_p95,
                100 * e.outside_99, 1e3 * e.position_rmse_m, 1e3 * e.position_sigma_m,
                1e3 * e.position_max_m, 1e3 * e.rotation_rmse_rad, 1e3 * e.rotation_sigma_rad);
  return line;
}

}  // namespace

Json jsonOf(const NormalizedErrors& e) {
  return {{"poses", e.poses},
          {"nees_per_dof",
           {{"pose", e.pose},
            {"position", e.position},
            {"rotation", e.rotation},
            {"pose_p95", e.pose_p95}}},
          {"share_outside_99_percent", e.outside_99},
          {"position_rmse_m", e.position_rmse_m},
          {"position_sigma_m", e.position_sigma_m},
          {"position_max_m", e.position_max_m},
          {"rotation_rmse_rad", e.rotation_rmse_rad},
          {"rotation_sigma_rad", e.rotation_sigma_rad}};
}

std::string tableOf(const std::map<std::string, NormalizedErrors>& rows,
                    const NormalizedErrors& all) {
  std::string out =
      "                              NEES per degree of freedom            outside     position "
      "(mm)"
      "             rotation (mrad)\n"
      "                      poses    pose  position  rotation     p95   99 % of it     RMSE     "
      "sigma"
      "      max      RMSE     sigma\n";
  for (const auto& [name, errors] : rows) out += rowOf(name, errors);
  return out + rowOf("all", all);
}

std::string tableOf(const EvalCovarianceResult& result) {
  std::string out = "matched " + std::to_string(result.all.poses + result.unusable) + " of " +
                    std::to_string(result.estimate_poses) + " poses\n\n" +
                    tableOf(result.by_flag, result.all);
  if (result.unusable > 0) {
    out += "\n" + std::to_string(result.unusable) +
           " poses have a covariance that is not positive definite: left out\n";
  }
  return out;
}

Json jsonOf(const EvalCovarianceResult& result) {
  Json json;
  json["reference_poses"] = result.reference_poses;
  json["estimate_poses"] = result.estimate_poses;
  json["unusable_covariances"] = result.unusable;
  json["all"] = jsonOf(result.all);
  json["by_flag"] = Json::object();
  for (const auto& [flag, errors] : result.by_flag) json["by_flag"][flag] = jsonOf(errors);
  return json;
}

}  // namespace paloc

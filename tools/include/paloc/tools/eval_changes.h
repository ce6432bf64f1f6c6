#pragma once

#include <array>
#include <cstddef>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "paloc/map/map_changes.h"
#include "paloc/tools/change_truth.h"

namespace paloc {

/// How well one kind of change was found.
struct ChangeScore {
  MapChange kind = MapChange::kGone;
  std::size_t reported = 0;  ///< points
  std::size_t correct = 0;   ///< of these, where the truth has this kind
  std::size_t there = 0;     ///< points of the map or the scans where the truth has this kind
  std::size_t found = 0;     ///< of these, with a reported point near

  std::optional<double> precision() const;
  std::optional<double> recall() const;
};

/// How much of one object was found.
struct ObjectScore {
  std::string name;
  MapChange kind = MapChange::kGone;
  std::size_t there = 0, found = 0;
};

struct EvalChangesResult {
  std::array<ChangeScore, 4> kinds;  ///< in the order of kAllMapChanges
  std::vector<ObjectScore> objects;
};

/// What changes are compared with besides the truth: thinned to 5 cm.
struct EvalChangesInput {
  MapChanges changes;
  PointCloud map;    ///< the prior map: how much of what is gone was found
  PointCloud scans;  ///< the result's map.ply: the same of what was added, and moved
};

/// Compares with the truth. A reported point is correct within `tolerance_m` of what changed; what
/// stands on the floor begins as far above it.
EvalChangesResult evaluateChanges(const ChangeTruth& truth, const EvalChangesInput& input,
                                  double tolerance_m);

std::string tableOf(const EvalChangesResult& result);
nlohmann::ordered_json jsonOf(const EvalChangesResult& result);

}  // namespace paloc

#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "paloc/core/map_matcher.h"

namespace paloc {

/// A scan that was looked for in a map, for the user.
struct LocatedScan {
  std::string scan, map;  ///< the files
  MapMatch match;
  double load_s = 0, locate_s = 0;
};

std::string tableOf(const LocatedScan& located);
nlohmann::ordered_json jsonOf(const LocatedScan& located);

}  // namespace paloc

#include "section.h"

namespace paloc {

std::vector<Setting> changeSettings() {
  using S = ChangeSettings;
  Section s(
      "changes", [](auto& config) -> auto& { return config.changes; });
  s.number("max_range_m", &S::max_range_m, "m", {1, 1000}, "Rays are used up to this length.");
  s.number("max_position_sigma_m", &S::max_position_sigma_m, "m", {1e-3, 10},
           "Scans of poses less sure than this are not used.");
  s.number("clear_m", &S::clear_m, "m", {0, 1},
           "A ray passes through a surface if it ends so far behind it, beyond all noise.");
  s.number("min_incidence_cos", &S::min_incidence_cos, "", {0.01, 1},
           "A ray that grazes a surface more (cosine to its normal) tells nothing of it.");
  s.count("min_scans", &S::min_scans, {1, 1000}, "Scans that must agree on a change.");
  s.number("min_persistence_s", &S::min_persistence_s, "s", {0, 1e6},
           "Something added is seen at times that lie so far apart.");
  s.count("min_object_points", &S::min_object_points, {1, 1'000'000},
          "Something added or unmapped consists of so many points, 5 cm apart.");
  s.number(
      "min_dominance", &S::min_dominance, "", {1, 1000},
      "Scans that see through something over those that see it, for it to be gone; or the other "
      "way, for it to stand.");
  return std::move(s).rows();
}

}  // namespace paloc

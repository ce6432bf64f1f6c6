#pragma once

namespace paloc {

/// Settings of the search for what differs between the prior map and the scans.
struct ChangeSettings {
  double max_range_m = 30;             ///< of a ray, as far as it is used
  double max_position_sigma_m = 0.03;  ///< scans of poses less sure than this are not used
  double clear_m = 0.04;  ///< beyond all noise: a ray that ends this far behind passed through
  double min_incidence_cos = 0.26;  ///< rays that graze a surface more than this tell nothing of it
  int min_scans = 3;                ///< that must agree on a change
  double min_persistence_s = 2;     ///< something added is seen at times this far apart
  int min_object_points = 30;       ///< of 5 cm each, that something added or unmapped consists of
  double min_dominance = 4;         ///< of scans that see through a surface over those that see it
};

}  // namespace paloc

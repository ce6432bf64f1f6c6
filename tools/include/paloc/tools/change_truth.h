#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "paloc/core/pose.h"

namespace paloc {

/// Where a simulated place was changed: changes.json of `paloc synth --change`. Map frame, m.
class ChangeTruth {
 public:
  struct Box {
    std::string name;
    Pose T_map_box;
    Vec3 low = Vec3::Zero(), high = Vec3::Zero();

    /// Whether it holds a point, grown by a margin (m) to all sides but downwards by `below_m`.
    bool contains(const Vec3& p_map, double margin_m, double below_m) const;
  };
  struct Region {
    Vec3 low = Vec3::Zero(), high = Vec3::Zero();
    bool contains(const Vec3& p_map, double margin_m) const;
  };

  /// Throws IoError if the file cannot be read or is none of these.
  static ChangeTruth load(const std::filesystem::path& file);

  std::vector<Box> gone, added;
  std::vector<Region> missing;  ///< of the map

  /// Whether some person was at a place at any time; margins as Box::contains.
  bool sweptByPeople(const Vec3& p_map, double margin_m, double below_m) const;

 private:
  double radius_m_ = 0, height_m_ = 0;
  std::vector<std::vector<Vec3>> tracks_;
};

}  // namespace paloc

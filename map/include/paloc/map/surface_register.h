#pragma once

#include <array>
#include <cstdint>
#include <unordered_map>
#include <vector>

#include "paloc/core/export.h"
#include "paloc/core/types.h"

namespace paloc {

/// Gives the surfaces of a map their numbers, by the patches of them that scans lie on: a patch is
/// of a surface that was seen before where its plane goes on (normal within 12 degrees, height
/// within 10 cm) and a patch of that one lies within `reach_m`. A wall is one surface however long
/// it is. In order, so that the same patches get the same numbers.
class PALOC_EXPORT SurfaceRegister {
 public:
  explicit SurfaceRegister(double reach_m) : reach_m_(reach_m) {}

  /// The surface, from 0, of a patch with this unit normal and centre (map frame).
  int surfaceOf(const Vec3& normal, const Vec3& point);
  int size() const { return static_cast<int>(normals_.size()); }

 private:
  struct Place {
    Vec3 point = Vec3::Zero();
    int surface = 0;
  };
  struct Found {
    int surface = -1;
    double distance_m = 0;
  };
  std::array<std::int64_t, 3> cellOf(const Vec3& point) const;
  void searchCell(std::uint64_t key, const Vec3& normal, const Vec3& point, Found& found) const;
  Found nearest(const Vec3& normal, const Vec3& point) const;

  double reach_m_;
  std::vector<Vec3> normals_;  // of the surfaces, where they were first seen
  std::unordered_map<std::uint64_t, std::vector<Place>> cells_;
};

}  // namespace paloc

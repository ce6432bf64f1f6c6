#pragma once

#include <array>
#include <cstdint>
#include <unordered_map>

#include "paloc/core/export.h"
#include "paloc/core/types.h"

namespace paloc {

/// A line of a local map, in the map's frame.
struct LocalLine {
  Vec3 direction = Vec3::Zero();  ///< unit, either way
  Vec3 centroid = Vec3::Zero();   ///< of its points (m)
  double thickness_m = 0;         ///< standard deviation of its points across it, each way
  double length_m = 0;            ///< and along it
  int points = 0;
};

/// Cubic voxels of one size, each with the running moments of the edge points in it and the line
/// that these make: what PlaneVoxels is for planes. Same calls, same answers.
class PALOC_EXPORT LineVoxels {
 public:
  explicit LineVoxels(double edge_m) : edge_m_(edge_m) {}

  /// Adds an edge point (m). Points further from zero than 2^20 voxels are not taken: false.
  bool add(const Vec3& point);

  /// The line of the voxel that the point is in; false if its points make none.
  bool find(const Vec3& point, LocalLine& line) const;

  void clear() { cells_.clear(); }
  std::size_t size() const { return cells_.size(); }
  std::size_t bytes() const;

 private:
  struct Cell {
    Vec3 mean = Vec3::Zero();         // from the voxel's centre (m)
    std::array<double, 6> scatter{};  // sums of products of deviations: xx xy xz yy yz zz (m2)
    std::uint32_t points = 0;
    bool is_line = false;
    LocalLine line;
  };

  void fit(Cell& cell, const Vec3& centre) const;

  double edge_m_;
  std::unordered_map<std::uint64_t, Cell> cells_;
};

}  // namespace paloc

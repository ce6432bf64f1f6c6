#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <unordered_map>
#include <vector>

#include "cell_walk.h"
#include "paloc/core/types.h"
#include "paloc/map/map_plane.h"

namespace paloc {

/// A point that rays are tested against, with the surface about it if that is a plane. Local (m).
struct RayTarget {
  Point3f point;
  float nx = 0, ny = 0, nz = 0;  ///< unit normal, zero where there is no plane
  float offset_m = 0;            ///< as MapPlane::offset_m

  bool planar() const { return nx != 0 || ny != 0 || nz != 0; }
  Vec3 position() const {
    return {static_cast<double>(point.x), static_cast<double>(point.y),
            static_cast<double>(point.z)};
  }
  Vec3 normal() const {
    return {static_cast<double>(nx), static_cast<double>(ny), static_cast<double>(nz)};
  }
};

/// Targets by the cells of a grid: those in the cells along a ray, and those about a point. Cubes
/// of 8 x 8 x 8 cells are kept where there are targets at all.
class RayTargets {
 public:
  static constexpr double kCell_m = 0.1;

  explicit RayTargets(std::vector<RayTarget> targets);

  std::size_t size() const { return targets_.size(); }
  const RayTarget& operator[](std::uint32_t index) const { return targets_[index]; }
  void setPlane(std::uint32_t index, const MapPlane& plane);

  /// Calls visit(index) for targets in the cells along a line.
  template <typename Visit>
  void along(const Vec3& from, const Vec3& to, const Visit& visit) const {
    Cursor cursor;
    walkCells(from / kCell_m, to / kCell_m, [&](const Cell& cell) {
      visitCell(cell, cursor, visit);
      return true;
    });
  }

  /// Calls visit(index) for targets nearer to a point than a radius (m).
  template <typename Visit>
  void near(const Vec3& p, double radius_m, const Visit& visit) const {
    const Cell low = cellOf(p - Vec3::Constant(radius_m)),
               high = cellOf(p + Vec3::Constant(radius_m));
    Cursor cursor;
    for (int x = low[0]; x <= high[0]; ++x) {
      for (int y = low[1]; y <= high[1]; ++y) {
        for (int z = low[2]; z <= high[2]; ++z) {
          visitCell({x, y, z}, cursor, [&](std::uint32_t index) {
            if ((targets_[index].position() - p).squaredNorm() < radius_m * radius_m) visit(index);
          });
        }
      }
    }
  }

 private:
  using Cell = std::array<int, 3>;
  static constexpr std::uint32_t kNoCube = ~0U;
  /// The cube of the last cell.
  struct Cursor {
    std::uint64_t cube = ~0ULL;
    std::uint32_t index = kNoCube;
  };

  static Cell cellOf(const Vec3& p);
  static std::uint64_t cubeOf(const Cell& cell) {
    constexpr int kShift = 1 << 20;
    const auto part = [](int c) {
      const int cube = (c >> 3) + kShift;
      return static_cast<std::uint64_t>(cube) & 0x1fffffU;
    };
    return part(cell[0]) << 42 | part(cell[1]) << 21 | part(cell[2]);
  }
  static std::size_t inCube(const Cell& cell) {
    const auto part = [](int c) { return static_cast<std::size_t>(c & 7); };
    return part(cell[0]) + 8 * part(cell[1]) + 64 * part(cell[2]);
  }

  template <typename Visit>
  void visitCell(const Cell& cell, Cursor& cursor, const Visit& visit) const {
    const std::uint64_t cube = cubeOf(cell);
    if (cube != cursor.cube) {
      const auto found = cubes_.find(cube);
      cursor = {cube, found == cubes_.end() ? kNoCube : found->second};
    }
    if (cursor.index == kNoCube) return;
    const std::size_t at = 512 * static_cast<std::size_t>(cursor.index) + inCube(cell);
    for (std::uint32_t i = starts_[at]; i < starts_[at + 1]; ++i) visit(order_[i]);
  }

  std::vector<RayTarget> targets_;
  std::unordered_map<std::uint64_t, std::uint32_t> cubes_;
  std::vector<std::uint32_t> starts_;  // of each cell of each cube, in order_
  std::vector<std::uint32_t> order_;   // targets by cell
};

}  // namespace paloc

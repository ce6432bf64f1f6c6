#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "paloc/core/export.h"
#include "paloc/core/types.h"

namespace paloc {

/// A cubic cell by its number along each axis.
struct CellIndex {
  int x = 0, y = 0, z = 0;
};

/// The cells that a grid covers, and where it lies.
struct PALOC_EXPORT GridFrame {
  Vec3 low = Vec3::Zero();  ///< corner of cell (0, 0, 0) (m)
  double cell_m = 0.2;
  CellIndex size;  ///< cells along each axis

  /// The grid over a box, one cell wider on each side; its cells are grown until it has no more
  /// than `max_cells`.
  static GridFrame over(const Vec3& low, const Vec3& high, double finest_cell_m, double max_cells);
  Vec3 centre(const CellIndex& cell) const {
    return low + cell_m * Vec3(cell.x + 0.5, cell.y + 0.5, cell.z + 0.5);
  }
};

/// Which cells of a map are occupied, and for every cell and power of two whether anything within
/// the cube of 2^level cells that begins at it is: the maximum that a score can reach when a point
/// is moved by up to 2^level - 1 cells along each axis, in one look-up. In the manner of the
/// precomputed grids of Hess et al., "Real-Time Loop Closure in 2D LIDAR SLAM" (2016), here in
/// three dimensions and with one bit a cell.
class PALOC_EXPORT OccupancyPyramid {
 public:
  /// Cells that hold a point, and the six next to each: a point of a scan lies up to half a cell
  /// off for the grid of poses and as much for that of headings.
  OccupancyPyramid(const GridFrame& frame, std::span<const Point3f> points, int levels);

  int levels() const { return static_cast<int>(grids_.size()); }

  /// Whether any cell from (x, y, z) to (x, y, z) + 2^level - 1 is occupied. Cells outside the
  /// grid are free. (Where the cube begins outside the grid, the answer is that of the one that
  /// begins at its border: it may say yes too often, never no.)
  bool any(int level, int x, int y, int z) const {
    const int reach = 1 << level;
    if (x >= frame_.size.x || y >= frame_.size.y || z >= frame_.size.z) return false;
    if (x <= -reach || y <= -reach || z <= -reach) return false;
    return bit(grids_[static_cast<std::size_t>(level)], x < 0 ? 0 : x, y < 0 ? 0 : y,
               z < 0 ? 0 : z);
  }

 private:
  using Grid = std::vector<std::uint64_t>;

  std::size_t row(int y, int z) const {
    return (static_cast<std::size_t>(z) * static_cast<std::size_t>(frame_.size.y) +
            static_cast<std::size_t>(y)) *
           words_;
  }
  bool bit(const Grid& grid, int x, int y, int z) const {
    const auto at = static_cast<std::size_t>(x);
    return (grid[row(y, z) + at / 64] >> (at % 64) & 1) != 0;
  }
  void occupy(Grid& grid, int x, int y, int z) const;
  void widen(Grid& grid, int by) const;

  GridFrame frame_;
  std::size_t words_ = 0;  // of a row along x
  std::vector<Grid> grids_;
};

}  // namespace paloc

#include "paloc/map/occupancy_pyramid.h"

#include <algorithm>
#include <cmath>

namespace paloc {
namespace {

int cellOf(float coordinate, double low, double inverse_cell) {
  return static_cast<int>(std::floor((static_cast<double>(coordinate) - low) * inverse_cell));
}

}  // namespace

GridFrame GridFrame::over(const Vec3& low, const Vec3& high, double finest_cell_m,
                          double max_cells) {
  const auto cellsAlong = [&](int axis, double cell) {
    return std::floor((high[axis] - low[axis]) / cell) + 3;
  };
  GridFrame frame;
  frame.cell_m = finest_cell_m;
  constexpr double kGrowth = 1.1;
  while (cellsAlong(0, frame.cell_m) * cellsAlong(1, frame.cell_m) * cellsAlong(2, frame.cell_m) >
         max_cells) {
    frame.cell_m *= kGrowth;
  }
  frame.low = low - Vec3::Constant(frame.cell_m);
  frame.size = {static_cast<int>(cellsAlong(0, frame.cell_m)),
                static_cast<int>(cellsAlong(1, frame.cell_m)),
                static_cast<int>(cellsAlong(2, frame.cell_m))};
  return frame;
}

OccupancyPyramid::OccupancyPyramid(const GridFrame& frame, std::span<const Point3f> points,
                                   int levels)
    : frame_(frame), words_((static_cast<std::size_t>(frame.size.x) + 63) / 64) {
  Grid grid(words_ * static_cast<std::size_t>(frame.size.y) *
            static_cast<std::size_t>(frame.size.z));
  const double inverse_cell = 1 / frame.cell_m;
  for (const Point3f& p : points) {
    const int x = cellOf(p.x, frame.low.x(), inverse_cell),
              y = cellOf(p.y, frame.low.y(), inverse_cell),
              z = cellOf(p.z, frame.low.z(), inverse_cell);
    occupy(grid, x, y, z);
    for (const int by : {-1, 1}) {
      occupy(grid, x + by, y, z);
      occupy(grid, x, y + by, z);
      occupy(grid, x, y, z + by);
    }
  }
  grids_.push_back(std::move(grid));
  for (int level = 1; level < levels; ++level) {
    grids_.push_back(grids_.back());
    widen(grids_.back(), 1 << (level - 1));
  }
}

void OccupancyPyramid::occupy(Grid& grid, int x, int y, int z) const {
  if (x < 0 || y < 0 || z < 0 || x >= frame_.size.x || y >= frame_.size.y || z >= frame_.size.z) {
    return;
  }
  const auto at = static_cast<std::size_t>(x);
  grid[row(y, z) + at / 64] |= std::uint64_t{1} << (at % 64);
}

// Every cell takes on what lies `by` cells further along each axis, one axis after the other. In
// ascending order, what is read has not been written yet.
void OccupancyPyramid::widen(Grid& grid, int by) const {
  const auto shift = static_cast<std::size_t>(by);
  const std::size_t whole = shift / 64, rest = shift % 64;
  for (std::size_t first = 0; first < grid.size(); first += words_) {
    for (std::size_t w = 0; w + whole < words_; ++w) {
      std::uint64_t further = grid[first + w + whole] >> rest;
      if (rest != 0 && w + whole + 1 < words_) {
        further |= grid[first + w + whole + 1] << (64 - rest);
      }
      grid[first + w] |= further;
    }
  }
  const auto take = [&](std::size_t to, std::size_t from) {
    for (std::size_t w = 0; w < words_; ++w) grid[to + w] |= grid[from + w];
  };
  for (int z = 0; z < frame_.size.z; ++z) {
    for (int y = 0; y + by < frame_.size.y; ++y) take(row(y, z), row(y + by, z));
  }
  for (int z = 0; z + by < frame_.size.z; ++z) {
    for (int y = 0; y < frame_.size.y; ++y) take(row(y, z), row(y, z + by));
  }
}

}  // namespace paloc

#include "paloc/map/occupancy_pyramid.h"

#include <gtest/gtest.h>

#include <random>

namespace paloc {
namespace {

struct Cells {
  GridFrame frame;
  std::vector<Point3f> points;
};

// Longer along x than a word of bits, and shorter along z than the widest cube.
Cells someCells() {
  Cells cells;
  cells.frame = GridFrame::over(Vec3(-3, 1, 0), Vec3(27, 8, 2), 0.25, 1e6);
  std::mt19937 random(3);
  std::uniform_real_distribution<float> x(-3, 27), y(1, 8), z(0, 2);
  for (int i = 0; i < 60; ++i) cells.points.push_back({x(random), y(random), z(random)});
  return cells;
}

TEST(OccupancyPyramid, AnswersForCubesAsBruteForceDoes) {
  const Cells cells = someCells();
  const OccupancyPyramid pyramid(cells.frame, cells.points, 6);
  const CellIndex size = cells.frame.size;
  const auto occupied = [&](const CellIndex& first, int edge) {
    for (int z = first.z; z < first.z + edge; ++z) {
      for (int y = first.y; y < first.y + edge; ++y) {
        for (int x = first.x; x < first.x + edge; ++x) {
          if (pyramid.any(0, x, y, z)) return true;
        }
      }
    }
    return false;
  };
  std::mt19937 random(4);
  int yes = 0;
  for (int trial = 0; trial < 3000; ++trial) {
    const int level = static_cast<int>(random() % 6), edge = 1 << level;
    const auto within = [&](int cells_along) {
      return static_cast<int>(random() % static_cast<unsigned>(cells_along + 2 * edge)) - edge;
    };
    const CellIndex first{within(size.x), within(size.y), within(size.z)};
    const bool expected = occupied(first, edge),
               answer = pyramid.any(level, first.x, first.y, first.z);
    const bool inside = first.x >= 0 && first.y >= 0 && first.z >= 0;
    yes += expected;
    EXPECT_TRUE(inside ? answer == expected : answer >= expected)
        << level << ": " << first.x << ' ' << first.y << ' ' << first.z;
  }
  EXPECT_GT(yes, 300);
  EXPECT_LT(yes, 2500);
}

TEST(OccupancyPyramid, OccupiesTheCellOfAPointAndItsSixNeighbours) {
  const GridFrame frame = GridFrame::over(Vec3::Zero(), Vec3(4, 4, 4), 0.5, 1e6);
  const OccupancyPyramid pyramid(frame, std::vector<Point3f>{{2.2F, 2.2F, 2.2F}}, 1);
  int occupied = 0;
  for (int x = 0; x < frame.size.x; ++x) {
    for (int y = 0; y < frame.size.y; ++y) {
      for (int z = 0; z < frame.size.z; ++z) {
        if (!pyramid.any(0, x, y, z)) continue;
        ++occupied;
        EXPECT_LT((frame.centre({x, y, z}) - Vec3(2.25, 2.25, 2.25)).norm(), 0.51);
      }
    }
  }
  EXPECT_EQ(occupied, 7);
}

TEST(GridFrame, GrowsItsCellsForALargeMap) {
  const GridFrame frame = GridFrame::over(Vec3::Zero(), Vec3(500, 400, 40), 0.2, 1e6);
  EXPECT_LE(1.0 * frame.size.x * frame.size.y * frame.size.z, 1e6);
  EXPECT_GT(1.0 * frame.size.x * frame.size.y * frame.size.z, 5e5);
  EXPECT_GE(frame.size.x * frame.cell_m, 500 + 2 * frame.cell_m);
}

}  // namespace
}  // namespace paloc

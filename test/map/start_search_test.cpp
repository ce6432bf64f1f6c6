#include "paloc/map/start_search.h"

#include <gtest/gtest.h>

#include <random>

#include "paloc/core/so3.h"

namespace paloc {
namespace {

constexpr double kCell = 0.25;

/// A map of random points, of which a scan sees some from a pose, and some that are not there.
struct World {
  SearchMap map;
  SearchPoints points;
  Vec3 position;
  double yaw = 0;
};

World randomWorld(unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(-1, 1);
  std::vector<Point3f> cloud;
  std::vector<Vec3> exact;
  for (int i = 0; i < 80; ++i) {
    exact.emplace_back(5 * uniform(random), 4 * uniform(random), 1 + uniform(random));
    cloud.push_back({static_cast<float>(exact.back().x()), static_cast<float>(exact.back().y()),
                     static_cast<float>(exact.back().z())});
  }
  const GridFrame frame = GridFrame::over(Vec3(-5, -4, 0), Vec3(5, 4, 2), kCell, 1e6);
  World world{{frame, OccupancyPyramid(frame, cloud, 5), OccupancyPyramid(frame, cloud, 5)},
              {},
              Vec3(uniform(random), uniform(random), 1 + 0.5 * uniform(random)),
              3 * uniform(random)};
  const Mat3 back = so3::exp(Vec3(0, 0, -world.yaw));
  for (std::size_t i = 0; i < 50; ++i) {
    const Vec3 off = i % 5 == 0 ? Vec3(3 * uniform(random), 3 * uniform(random), 0) : Vec3::Zero();
    (i % 4 == 0 ? world.points.others : world.points.upright)
        .push_back(back * (exact[i] + off - world.position));
  }
  world.points.reach_m = 5;
  return world;
}

SearchBox wholeBox() { return {Vec3(-5, -4, 0), Vec3(5, 4, 2), -M_PI, M_PI}; }

// The hits of a pose, counted without the pyramid's upper levels.
int hitsAt(const World& world, const Vec3& position, double yaw) {
  const Mat3 rotation = so3::exp(Vec3(0, 0, yaw));
  int hits = 0;
  const auto count = [&](const OccupancyPyramid& grid, const std::vector<Vec3>& points) {
    for (const Vec3& p : points) {
      const Vec3 cell = (position + rotation * p - world.map.frame.low) / world.map.frame.cell_m;
      hits +=
          grid.any(0, static_cast<int>(std::floor(cell.x())),
                   static_cast<int>(std::floor(cell.y())), static_cast<int>(std::floor(cell.z())));
    }
  };
  count(world.map.upright, world.points.upright);
  count(world.map.all, world.points.others);
  return hits;
}

TEST(StartSearch, FindsThePoseThatTheScanWasTakenFrom) {
  for (unsigned seed = 0; seed < 10; ++seed) {
    const World world = randomWorld(seed);
    const StartCandidates answer =
        searchStarts(world.map, world.points, wholeBox(), {.min_share = 0.5});
    ASSERT_FALSE(answer.found.empty()) << seed;
    EXPECT_TRUE(answer.finished);
    EXPECT_LT((answer.found[0].position - world.position).norm(), 2 * kCell) << seed;
    EXPECT_LT(std::abs(std::remainder(answer.found[0].yaw - world.yaw, 2 * M_PI)), 0.1) << seed;
    EXPECT_EQ(answer.found[0].hits, hitsAt(world, answer.found[0].position, answer.found[0].yaw));
  }
}

// Branch and bound leaves nothing out: no pose of the grid has more hits than the first answer.
TEST(StartSearch, NoOtherPoseHasMoreHits) {
  const World world = randomWorld(11);
  const StartCandidates answer =
      searchStarts(world.map, world.points, wholeBox(), {.min_share = 0.3});
  ASSERT_FALSE(answer.found.empty());
  const CellIndex size = world.map.frame.size;
  for (int step = 0; step < 126; step += 3) {
    const double yaw =
        -M_PI + (step + 0.5) * 2 * M_PI / 126;  // 0.25 m at 5 m, as the search has it
    for (int x = 0; x < size.x; ++x) {
      for (int y = 0; y < size.y; ++y) {
        for (int z = 0; z < size.z; ++z) {
          ASSERT_LE(hitsAt(world, world.map.frame.centre({x, y, z}), yaw), answer.found[0].hits);
        }
      }
    }
  }
}

TEST(StartSearch, SameAnswerOnOneThreadAndTwo) {
  const World world = randomWorld(5);
  const auto on = [&](int threads) {
    return searchStarts(world.map, world.points, wholeBox(),
                        {.min_share = 0.3, .threads = threads});
  };
  const StartCandidates a = on(1), b = on(2);
  ASSERT_EQ(a.found.size(), b.found.size());
  for (std::size_t i = 0; i < a.found.size(); ++i) {
    EXPECT_EQ(a.found[i].position, b.found[i].position);
    EXPECT_EQ(a.found[i].yaw, b.found[i].yaw);
  }
}

TEST(StartSearch, SaysWhenItGaveUp) {
  const World world = randomWorld(5);
  const auto answer =
      searchStarts(world.map, world.points, wholeBox(), {.min_share = 0.3, .max_mlookups = 1e-4});
  EXPECT_FALSE(answer.finished);
  EXPECT_TRUE(searchStarts(world.map, {}, wholeBox(), {}).found.empty());
}

}  // namespace
}  // namespace paloc

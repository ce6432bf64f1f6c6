#include "paloc/map/octree_map.h"

#include <gtest/gtest.h>
#include <octomap/ColorOcTree.h>
#include <octomap/OcTree.h>

#include <cmath>
#include <map>
#include <random>
#include <set>
#include <sstream>

#include "cloud_files.h"
#include "gzipped.h"
#include "paloc/map/prior_map.h"

namespace paloc {
namespace {

using test::expectRefused;
using test::pointOf;
using State = OctreeMap::State;
using Cell = OctreeMap::Cell;

// Boxes of free and occupied cells at random, pruned to large leaves.
template <typename Tree>
void fill(Tree& tree, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_int_distribution<int> place(-40, 40), edge(1, 16);
  for (int box = 0; box < 60; ++box) {
    const int size = edge(random);
    const Cell low{place(random), place(random), place(random)};
    const bool occupied = box % 3 == 0;
    for (int i = 0; i < size * size * size; ++i) {
      const octomap::OcTreeKey key(
          static_cast<octomap::key_type>(32768 + low[0] + i % size),
          static_cast<octomap::key_type>(32768 + low[1] + i / size % size),
          static_cast<octomap::key_type>(32768 + low[2] + i / size / size));
      tree.setNodeValue(key, occupied ? 2.0F : -1.0F, true);
    }
  }
  tree.updateInnerOccupancy();
  tree.prune();
}

template <typename Tree>
State stateIn(const Tree& tree, const Cell& cell) {
  const auto* node =
      tree.search(octomap::OcTreeKey(static_cast<octomap::key_type>(32768 + cell[0]),
                                     static_cast<octomap::key_type>(32768 + cell[1]),
                                     static_cast<octomap::key_type>(32768 + cell[2])));
  if (node == nullptr) return State::kUnknown;
  return tree.isNodeOccupied(node) ? State::kOccupied : State::kFree;
}

template <typename Tree>
std::string written(Tree& tree, bool binary) {
  std::stringstream out;
  binary ? tree.writeBinary(out) : tree.write(out);
  return out.str();
}

template <typename Visit>
void forEachCellNear(const Visit& visit) {
  for (int i = -42; i < 58; ++i) {
    for (int j = -42; j < 58; ++j) {
      for (int k = -42; k < 58; ++k) visit(Cell{i, j, k});
    }
  }
}

template <typename Tree>
void expectSame(const OctreeMap& map, const Tree& tree) {
  std::size_t differing = 0, known = 0;
  forEachCellNear([&](const Cell& cell) {
    const State state = stateIn(tree, cell);
    known += state != State::kUnknown;
    differing += map.at(cell) != state;
  });
  EXPECT_EQ(differing, 0U);
  EXPECT_GT(known, 10'000U);
}

TEST(OctreeMap, HoldsWhatOctoMapWrote) {
  const test::TempDir folder;
  octomap::OcTree tree(0.05);
  fill(tree, 1);
  octomap::ColorOcTree coloured(0.05);
  fill(coloured, 2);
  const auto bt = OctreeMap::load(folder.write("a.bt", written(tree, true)));
  const auto ot = OctreeMap::load(folder.write("a.ot", written(tree, false)));
  const auto colour = OctreeMap::load(folder.write("c.ot", written(coloured, false)));
  EXPECT_EQ(bt.format(), "OctoMap .bt, OcTree");
  EXPECT_EQ(colour.format(), "OctoMap .ot, ColorOcTree");
  EXPECT_EQ(bt.resolution(), 0.05);
  expectSame(bt, tree);
  expectSame(ot, tree);
  expectSame(colour, coloured);
  EXPECT_EQ(bt.at(Cell{40'000, 0, 0}), State::kUnknown);
}

// Cells at the border of occupied space, by brute force.
std::set<Cell> borderCells(const octomap::OcTree& tree) {
  std::set<Cell> border;
  forEachCellNear([&](const Cell& cell) {
    if (stateIn(tree, cell) != State::kOccupied) return;
    for (int face = 0; face < 6; ++face) {
      if (stateIn(tree, neighbourOf(cell, face)) == State::kFree) border.insert(cell);
    }
  });
  return border;
}

TEST(OctreeMap, GivesThePointInTheMiddleOfEachCellThatBordersFreeSpaceOnce) {
  const test::TempDir folder;
  octomap::OcTree tree(0.2);
  fill(tree, 3);
  std::set<Cell> expected = borderCells(tree);
  for (const char* name : {"a.bt", "a.ot.gz"}) {
    const std::string bytes = written(tree, name[2] == 'b');
    const auto file = folder.write(name, name[2] == 'b' ? bytes : test::gzipped(bytes));
    const PointCloud cloud = loadCloud(file);
    std::set<Cell> got;
    for (std::size_t i = 0; i < cloud.size(); ++i) {
      const Vec3 p = pointOf(cloud, i) / 0.2;
      Cell cell;
      for (const std::size_t axis : {0U, 1U, 2U}) {
        const double coordinate = p[static_cast<Eigen::Index>(axis)];
        cell[axis] = static_cast<int>(std::floor(coordinate));
        EXPECT_NEAR(coordinate - std::floor(coordinate), 0.5, 1e-4);
      }
      EXPECT_TRUE(got.insert(cell).second);
    }
    EXPECT_EQ(got, expected);
    EXPECT_GT(got.size(), 300U);
  }
}

TEST(OctreeMap, PatchesAreAllFacesOfOccupiedCells) {
  const test::TempDir folder;
  octomap::OcTree tree(0.1);
  fill(tree, 4);
  const auto map = OctreeMap::load(folder.write("a.bt", written(tree, true)));
  std::map<std::pair<Cell, int>, State> faces;
  map.forEachPatch([&](const OctreeMap::Patch& patch) {
    forEachCell(patch, [&](const Cell& cell) {
      EXPECT_TRUE(faces.insert({{cell, patch.face}, patch.beyond}).second);
    });
  });
  std::size_t expected = 0, wrong = 0;
  forEachCellNear([&](const Cell& cell) {
    if (stateIn(tree, cell) != State::kOccupied) return;
    for (int face = 0; face < 6; ++face) {
      const State beyond = stateIn(tree, neighbourOf(cell, face));
      if (beyond == State::kOccupied) continue;
      ++expected;
      const auto found = faces.find({cell, face});
      wrong += found == faces.end() || found->second != beyond;
    }
  });
  EXPECT_EQ(faces.size(), expected);
  EXPECT_EQ(wrong, 0U);
}

// A room 8 x 6 x 3 m, turned by 20 degrees, somewhere on the grid, scanned with a noise of 1 cm.
struct ScannedRoom {
  static constexpr double kNoise_m = 0.01;
  Eigen::AngleAxisd turned{20 * M_PI / 180, Vec3::UnitZ()};
  Vec3 middle = Vec3::Zero();
  Vec3 half{4, 3, 1.5};

  explicit ScannedRoom(unsigned seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> uniform(0, 1);
    for (int axis = 0; axis < 3; ++axis) middle[axis] = uniform(random);
  }

  octomap::point3d mapped(const Vec3& p) const {
    const Vec3 q = turned * p + middle;
    return {static_cast<float>(q.x()), static_cast<float>(q.y()), static_cast<float>(q.z())};
  }

  octomap::OcTree scan(double cell_m, int rays) const {
    octomap::OcTree tree(cell_m);
    std::mt19937 random(5);
    std::normal_distribution<double> normal;
    for (int scan = 0; scan < 10; ++scan) {
      const Vec3 sensor(normal(random), 0.7 * normal(random), 0.1 * normal(random));
      octomap::Pointcloud points;
      for (int ray = 0; ray < rays; ++ray) {
        const Vec3 d = Vec3(normal(random), normal(random), normal(random)).normalized();
        double range = 1e9;
        for (int axis = 0; axis < 3; ++axis) {
          range = std::min(range, ((d[axis] > 0 ? 1 : -1) * half[axis] - sensor[axis]) / d[axis]);
        }
        points.push_back(mapped(sensor + (range + kNoise_m * normal(random)) * d));
      }
      tree.insertPointCloud(points, mapped(sensor), -1, true, true);
    }
    tree.updateInnerOccupancy();
    return tree;
  }

  // Mean over the room's surfaces of the distance (m) of the map's planes behind them.
  double meanDepth(const PriorMap& map) const {
    std::map<std::pair<Eigen::Index, bool>, std::pair<double, int>> surfaces;
    for (std::uint32_t i = 0; i < map.size(); ++i) {
      const MapPlane plane = map.plane(i);
      if (!plane.planar()) continue;
      const Point3f& q = map.point(i);
      const Vec3 n = turned.inverse() * Vec3(plane.nx, plane.ny, plane.nz);
      const Vec3 p = turned.inverse() * Vec3(map.origin() + Vec3(q.x, q.y, q.z) - middle) +
                     static_cast<double>(plane.offset_m) * n;
      Eigen::Index axis = 0;
      if (n.cwiseAbs().maxCoeff(&axis) < 0.97) continue;
      auto& [sum, count] = surfaces[{axis, p[axis] > 0}];
      sum += std::abs(p[axis]) - half[axis];
      ++count;
    }
    EXPECT_EQ(surfaces.size(), 6U);
    double sum = 0;
    for (const auto& [surface, depths] : surfaces) sum += depths.first / depths.second;
    return sum / static_cast<double>(surfaces.size());
  }
};

// Where in its cell a surface lies is chance (29 % of a cell, one sigma); the mean over many
// surfaces is what a choice of the points' place in the cell would shift: by half a cell, if they
// were on the face.
void expectSmallBias(double cell_m, int rays, unsigned rooms) {
  const test::TempDir folder;
  double depth = 0;
  for (unsigned seed = 0; seed < rooms; ++seed) {
    const ScannedRoom room(seed);
    octomap::OcTree tree = room.scan(cell_m, rays);
    const auto map = PriorMap::load(folder.write("room.bt", written(tree, true)), {});
    EXPECT_GT(map->statistics().planar, map->size() / 2);
    depth += room.meanDepth(*map) / rooms;
  }
  EXPECT_LT(std::abs(depth), 0.2 * cell_m) << cell_m << ": " << depth;
}

TEST(OctreeMap, PlanesLieWhereTheSurfaceWasAtFiveCentimetres) { expectSmallBias(0.05, 12'000, 1); }

TEST(OctreeMap, PlanesLieWhereTheSurfaceWasAtTwentyCentimetres) { expectSmallBias(0.2, 4'000, 6); }

TEST(OctreeMap, RefusesWhatIsBroken) {
  const test::TempDir folder;
  octomap::OcTree tree(0.1);
  fill(tree, 6);
  const std::string bt = written(tree, true), ot = written(tree, false);
  const auto replaced = [](std::string bytes, const std::string& from, const std::string& to) {
    return bytes.replace(bytes.find(from), from.size(), to);
  };
  const std::string size = "size " + std::to_string(tree.size());
  const auto sized = [&](std::size_t n) { return "size " + std::to_string(n); };
  expectRefused(folder, "a.bt", bt.substr(0, bt.size() - 3), "is cut off");
  expectRefused(folder, "b.ot", ot.substr(0, ot.size() / 2), "is cut off");
  expectRefused(folder, "c.bt", bt + "x", "goes on after the last node");
  expectRefused(folder, "d.bt", replaced(bt, size, sized(tree.size() + 1)), "but it holds");
  expectRefused(folder, "e.bt", replaced(bt, size, sized(tree.size() - 1)), "but it holds");
  expectRefused(folder, "f.bt", replaced(bt, size, sized(99'999'999'999)), "have no room");
  expectRefused(folder, "g.bt", replaced(bt, "res 0.1", "res 0"), "no line 'res'");
  expectRefused(folder, "h.bt", replaced(bt, "res 0.1", "res nan"), "no line 'res'");
  expectRefused(folder, "i.bt", replaced(bt, "id OcTree", "id Quadtree"), "kind 'Quadtree'");
  expectRefused(folder, "j.bt", replaced(bt, "data", "dada"), "not known in an OctoMap header");
  expectRefused(folder, "k.bt", "# Octomap OcTree binary file\nid OcTree\n", "no line 'data'");
  expectRefused(folder, "l.bt", "hello", "does not begin with '# Octomap OcTree'");
  expectRefused(folder, "m.bt", "# Octomap OcTree text\n", "line 1");
  const std::string head = "# Octomap OcTree binary file\nid OcTree\nsize 9\nres 0.1\ndata\n";
  expectRefused(folder, "n.bt", head + "\xaa\xaa", "no occupied cell that borders free space");
  expectRefused(folder, "o.bt", replaced(head, "size 9", "size 21") + std::string(40, '\xff'),
                "deeper than 16 levels");
  std::mt19937 random(7);
  for (int run = 0; run < 300; ++run) {
    std::string damaged = run % 2 == 0 ? bt : ot;
    damaged[100 + random() % (damaged.size() - 100)] = static_cast<char>(random());
    test::refusal(folder.write("d.bt", damaged));  // reads or refuses, never crashes
  }
}

}  // namespace
}  // namespace paloc

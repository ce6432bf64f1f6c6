#include "paloc/map/octree_map.h"

#include <algorithm>
#include <cmath>

#include "input_file.h"
#include "octree_map_reader.h"

namespace paloc {
namespace {

constexpr int kHalf = 1 << 15;  // cells from the middle to the border of space
constexpr int kWhole = 1 << 16;

bool inSpace(const OctreeMap::Cell& cell) {
  return std::all_of(cell.begin(), cell.end(), [](int i) { return i >= -kHalf && i < kHalf; });
}

OctreeMap::Cell childLow(const OctreeMap::Cell& low, int half, unsigned child) {
  return {low[0] + ((child & 1) != 0 ? half : 0), low[1] + ((child & 2) != 0 ? half : 0),
          low[2] + ((child & 4) != 0 ? half : 0)};
}

}  // namespace

OctreeMap OctreeMap::load(const std::filesystem::path& file) {
  return readOctreeMap(InputFile(file), MemoryBudget());
}

OctreeMap::Cell neighbourOf(const OctreeMap::Cell& cell, int face) {
  OctreeMap::Cell next = cell;
  next[static_cast<std::size_t>(face) / 2] += face % 2 == 0 ? -1 : 1;
  return next;
}

OctreeMap::Cell OctreeMap::cellOf(const Vec3& p_map) const {
  const auto index = [this](double coordinate) {
    constexpr double kFar = 2 * kHalf;
    return static_cast<int>(std::clamp(std::floor(coordinate / resolution_m_), -kFar, kFar));
  };
  return {index(p_map.x()), index(p_map.y()), index(p_map.z())};
}

Vec3 OctreeMap::centre(const Cell& cell) const {
  return Vec3(cell[0] + 0.5, cell[1] + 0.5, cell[2] + 0.5) * resolution_m_;
}

// The node of a cube of cells, or the leaf that holds it.
std::uint32_t OctreeMap::nodeAt(const Cell& low, int edge) const {
  std::uint32_t node = 0;
  for (int half = kWhole / 2; half >= edge && nodes_[node].first_child != 0; half /= 2) {
    const auto bit = [&](std::size_t axis) {
      return ((low[axis] + kHalf) & half) != 0 ? 1U << axis : 0U;
    };
    node = nodes_[node].first_child + (bit(0) | bit(1) | bit(2));
  }
  return node;
}

OctreeMap::State OctreeMap::at(const Cell& cell) const {
  return inSpace(cell) ? nodes_[nodeAt(cell, 1)].state : State::kUnknown;
}

void OctreeMap::visitLeaves(std::uint32_t node, const Cell& low, int edge,
                            const std::function<void(const Leaf&)>& visit) const {
  const Node& here = nodes_[node];
  if (here.first_child == 0) {
    if (here.state != State::kUnknown) visit({low, edge, here.state});
    return;
  }
  for (unsigned child = 0; child < 8; ++child) {
    visitLeaves(here.first_child + child, childLow(low, edge / 2, child), edge / 2, visit);
  }
}

void OctreeMap::forEachLeaf(const std::function<void(const Leaf&)>& visit) const {
  visitLeaves(0, {-kHalf, -kHalf, -kHalf}, kWhole, visit);
}

// `beyond` is the node of the cube on the other side of the patch, of the same edge, or the leaf
// that holds it.
void OctreeMap::visitFace(std::uint32_t beyond, const Patch& patch,
                          const std::function<void(const Patch&)>& visit) const {
  const Node& node = nodes_[beyond];
  if (node.first_child == 0) {
    if (node.state == State::kOccupied) return;
    Patch whole = patch;
    whole.beyond = node.state;
    visit(whole);
    return;
  }
  const unsigned axis = static_cast<unsigned>(patch.face) / 2;
  const unsigned near_side = patch.face % 2 == 0 ? 1U << axis : 0U;  // of beyond, touching us
  const int half = patch.edge / 2;
  for (unsigned child = 0; child < 8; ++child) {
    if ((child & (1U << axis)) != near_side) continue;
    Patch part = patch;
    part.edge = half;
    part.low = childLow(patch.low, half, child & ~(1U << axis));
    visitFace(node.first_child + child, part, visit);
  }
}

void OctreeMap::forEachPatch(const std::function<void(const Patch&)>& visit) const {
  forEachLeaf([&](const Leaf& leaf) {
    if (leaf.state != State::kOccupied) return;
    for (int face = 0; face < 6; ++face) {
      const auto axis = static_cast<std::size_t>(face) / 2;
      Patch patch{leaf.low, leaf.edge, face, State::kUnknown};
      if (face % 2 == 1) patch.low[axis] += leaf.edge - 1;
      Cell beyond = leaf.low;
      beyond[axis] += face % 2 == 0 ? -leaf.edge : leaf.edge;
      if (inSpace(beyond)) {
        visitFace(nodeAt(beyond, leaf.edge), patch, visit);
      } else {
        visit(patch);
      }
    }
  });
}

}  // namespace paloc

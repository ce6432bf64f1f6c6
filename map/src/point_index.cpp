#include "point_index.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "parallel_chunks.h"

namespace paloc {
namespace {

constexpr std::size_t kChunk = 4096;
constexpr double kRoundedUp = 1 + 1e-5;
constexpr double kMaxReach = 0.5;  // in edges of a cube: beyond, the tree has less to look at

}  // namespace

void PointIndex::enclose(const PointBlock& block, BoxGroup& group, std::size_t lane) {
  const auto side = [lane](const float* values, float* low, float* high) {
    float smallest = values[0], largest = values[0];  // the first is never missing
    for (std::size_t i = 1; i < PointBlock::kPoints; ++i) {
      smallest = std::min(smallest, values[i]);
      if (values[i] < PointBlock::kMissing) largest = std::max(largest, values[i]);
    }
    low[lane] = smallest, high[lane] = largest;
  };
  side(block.x, group.low[0], group.high[0]);
  side(block.y, group.low[1], group.high[1]);
  side(block.z, group.low[2], group.high[2]);
}

void PointIndex::enclose(const BoxGroup& inner, BoxGroup& group, std::size_t lane) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    float smallest = inner.low[axis][0], largest = inner.high[axis][0];
    for (std::size_t i = 1; i < kFan; ++i) {
      smallest = std::min(smallest, inner.low[axis][i]);
      if (inner.high[axis][i] < PointBlock::kMissing) {
        largest = std::max(largest, inner.high[axis][i]);
      }
    }
    group.low[axis][lane] = smallest, group.high[axis][lane] = largest;
  }
}

template <typename Item>
RawArray<PointIndex::BoxGroup> PointIndex::groupsOver(const Item* items, std::size_t count,
                                                      tbb::task_arena& arena) {
  RawArray<BoxGroup> groups(chunkCount(count, kFan));
  forEachChunk(arena, groups.size(), kChunk, [&](std::size_t, std::size_t begin, std::size_t end) {
    for (std::size_t g = begin; g < end; ++g) {
      BoxGroup& group = groups[g];
      for (std::size_t axis = 0; axis < 3; ++axis) {
        std::fill_n(group.low[axis], kFan, PointBlock::kMissing);
        std::fill_n(group.high[axis], kFan, PointBlock::kMissing);
      }
      const std::size_t last = std::min((g + 1) * kFan, count);
      for (std::size_t i = g * kFan; i < last; ++i) enclose(items[i], group, i % kFan);
    }
  });
  return groups;
}

PointIndex::PointIndex(const RawArray<PointBlock>& blocks, std::size_t points, double voxel_m,
                       tbb::task_arena& arena)
    : blocks_(blocks.data()), block_count_(blocks.size()), points_(points) {
  if (points_ == 0) return;
  levels_.push_back(groupsOver(blocks_, block_count_, arena));
  while (levels_.back().size() > 1) {
    RawArray<BoxGroup> groups = groupsOver(levels_.back().data(), levels_.back().size(), arena);
    levels_.push_back(std::move(groups));
  }
  const Eigen::Vector3f low = box().low;
  cubes_ = CubeTable(blocks_, points_, {low.x(), low.y(), low.z()}, voxel_m, arena);
}

void PointIndex::searchCube(const CubeTable::Cube& cube, const Point3f& query, Found& best) const {
  cubes_.visit(cube, [&](std::uint32_t first, std::uint32_t count) {
    const auto last = static_cast<std::uint32_t>((first + count - 1) / PointBlock::kPoints);
    for (auto b = static_cast<std::uint32_t>(first / PointBlock::kPoints); b <= last; ++b) {
      searchBlock(
          b, query, [](std::uint32_t) { return true; }, best);
    }
  });
}

void PointIndex::prefetchPoints(const Point3f& query) const {
  cubes_.visit(cubes_.cubeOf(query), [&](std::uint32_t first, std::uint32_t count) {
    constexpr std::size_t kLine = 64;
    const auto* at = reinterpret_cast<const char*>(blocks_ + first / PointBlock::kPoints);
    const auto* end =
        reinterpret_cast<const char*>(blocks_ + (first + count - 1) / PointBlock::kPoints + 1);
    for (; at < end; at += kLine) __builtin_prefetch(at);
  });
}

// The cube of the query mostly holds a point; what is nearer lies in it or in a cube beside it.
PointIndex::Found PointIndex::nearest(const Point3f& query, float nearer_than_sq) const {
  const auto any = [](std::uint32_t) { return true; };
  if (points_ == 0) return {kNone, nearer_than_sq};
  Found best{kNone, nearer_than_sq};
  const CubeTable::Cube home = cubes_.cubeOf(query);
  searchCube(home, query, best);
  const double reach = std::sqrt(static_cast<double>(best.distance_sq)) * kRoundedUp;
  if (reach > kMaxReach * cubes_.edge()) {
    const Found found = nearest(query, best.distance_sq, any);
    return found.index == kNone ? best : found;
  }
  const CubeTable::Cube low = cubes_.cubeOf(query, -reach), high = cubes_.cubeOf(query, reach);
  const std::array<double, 3> off = cubes_.distancesSq(query, low, home);
  const auto apart = [&](const CubeTable::Cube& cube) {
    double sum = 0;
    for (std::size_t axis = 0; axis < 3; ++axis) sum += cube[axis] == home[axis] ? 0 : off[axis];
    return sum;
  };
  CubeTable::Cube cube;
  for (cube[0] = low[0]; cube[0] <= high[0]; ++cube[0]) {
    for (cube[1] = low[1]; cube[1] <= high[1]; ++cube[1]) {
      for (cube[2] = low[2]; cube[2] <= high[2]; ++cube[2]) {
        if (cube == home || apart(cube) > kRoundedUp * static_cast<double>(best.distance_sq)) {
          continue;
        }
        searchCube(cube, query, best);
      }
    }
  }
  return best;
}

std::size_t PointIndex::bytes() const {
  std::size_t sum = block_count_ * sizeof(PointBlock);
  for (const auto& level : levels_) sum += level.size() * sizeof(BoxGroup);
  return sum + cubes_.bytes();
}

PointIndex::Box PointIndex::box() const {
  const BoxGroup& top = levels_.back()[0];
  BoxGroup whole{};
  enclose(top, whole, 0);
  return {{whole.low[0][0], whole.low[1][0], whole.low[2][0]},
          {whole.high[0][0], whole.high[1][0], whole.high[2][0]}};
}

}  // namespace paloc

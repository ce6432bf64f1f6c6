#pragma once

#include <tbb/task_arena.h>

#include <bit>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "cube_table.h"
#include "lanes4.h"
#include "paloc/core/types.h"
#include "point_block.h"
#include "raw_array.h"

namespace paloc {

/// Search in points that lie along a Hilbert curve. Such points are a tree already: every eight
/// of them a leaf, every eight leaves a node, and so on; what is kept of it is a bounding box for
/// each leaf and node. The boxes take one pass to make (a k-d tree of nanoflann over eight million
/// points takes about a second), and a node's eight boxes are tested side by
/// side. Where points are near, a table of cubes finds them without a way through the tree. Exact:
/// the answers are those of brute force. Every query may be made from any thread.
class PointIndex {
 public:
  static constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

  struct Found {
    std::uint32_t index = kNone;
    float distance_sq = 0;  ///< m2
  };

  PointIndex() = default;
  /// Refers to points along a curve through voxels of `voxel_m`; the last block may have missing
  /// ones.
  PointIndex(const RawArray<PointBlock>& blocks, std::size_t points, double voxel_m,
             tbb::task_arena& arena);

  std::size_t size() const { return points_; }
  std::size_t blocks() const { return block_count_; }
  std::size_t bytes() const;  ///< of points and boxes

  struct Box {
    Eigen::Vector3f low, high;
  };
  Box box() const;  ///< about all points; there must be one

  Point3f point(std::uint32_t index) const { return pointAt(blocks_, index); }

  /// Of a point in one of its blocks.
  std::uint32_t indexOf(const PointBlock& block, std::size_t lane) const {
    const auto number = static_cast<std::size_t>(&block - blocks_);
    return static_cast<std::uint32_t>(number * PointBlock::kPoints + lane);
  }

  /// The nearest of the points that `accept(index)` holds for, nearer than the given distance; of
  /// several equally near, any one, but always the same.
  template <typename Accept>
  Found nearest(const Point3f& query, float nearer_than_sq, const Accept& accept) const;
  Found nearest(const Point3f& query, float nearer_than_sq) const;

  /// Fetches what a search for the nearest will need, in two steps, so that it need not wait.
  void prefetchTable(const Point3f& query) const { cubes_.prefetch(cubes_.cubeOf(query)); }
  void prefetchPoints(const Point3f& query) const;

  /// Calls visit(block) for every block whose box is nearer than the given distance, in a fixed
  /// order.
  template <typename Visit>
  void visitNear(const Point3f& query, float nearer_than_sq, const Visit& visit) const;

 private:
  static constexpr std::size_t kFan = 8;
  static constexpr std::size_t kMaxLevels = 11;  // 8^11 exceeds what 32 bits count

  /// Bounding boxes of eight blocks or groups; what is missing lies far away.
  struct BoxGroup {
    float low[3][kFan], high[3][kFan];  // x, y, z
  };
  struct Step {
    float distance_sq;
    std::uint32_t group;
    std::uint32_t level;
  };

  static Float4 outside(const float* low, const float* high, float value);
  static unsigned nearBoxes(const BoxGroup& group, const Point3f& query, float nearer_than_sq,
                            float* distances_sq);
  static void enclose(const PointBlock& block, BoxGroup& group, std::size_t lane);
  static void enclose(const BoxGroup& inner, BoxGroup& group, std::size_t lane);
  template <typename Item>
  static RawArray<BoxGroup> groupsOver(const Item* items, std::size_t count,
                                       tbb::task_arena& arena);
  template <typename Accept>
  void searchBlock(std::uint32_t block, const Point3f& query, const Accept& accept,
                   Found& best) const;
  void searchCube(const CubeTable::Cube& cube, const Point3f& query, Found& best) const;

  const PointBlock* blocks_ = nullptr;
  std::size_t block_count_ = 0, points_ = 0;
  std::vector<RawArray<BoxGroup>> levels_;  // boxes of blocks, of groups of blocks, ...
  CubeTable cubes_;
};

// How far a coordinate lies outside four intervals.
inline Float4 PointIndex::outside(const float* low, const float* high, float value) {
  return max4(max4(load4(low) - value, value - load4(high)), Float4{});
}

inline unsigned PointIndex::nearBoxes(const BoxGroup& group, const Point3f& query,
                                      float nearer_than_sq, float* distances_sq) {
  unsigned bits = 0;
  for (std::size_t half = 0; half < 2; ++half) {
    const std::size_t at = 4 * half;
    const Float4 dx = outside(group.low[0] + at, group.high[0] + at, query.x);
    const Float4 dy = outside(group.low[1] + at, group.high[1] + at, query.y);
    const Float4 dz = outside(group.low[2] + at, group.high[2] + at, query.z);
    const Float4 distance_sq = dx * dx + dy * dy + dz * dz;
    store4(distances_sq + at, distance_sq);
    bits |= bitsOf(distance_sq < nearer_than_sq) << at;
  }
  return bits;
}

template <typename Accept>
void PointIndex::searchBlock(std::uint32_t block_index, const Point3f& query, const Accept& accept,
                             Found& best) const {
  const PointBlock& block = blocks_[block_index];
  float distances_sq[PointBlock::kPoints];
  unsigned bits = 0;
  for (std::size_t at = 0; at < PointBlock::kPoints; at += 4) {
    const Float4 dx = load4(block.x + at) - query.x, dy = load4(block.y + at) - query.y,
                 dz = load4(block.z + at) - query.z;
    const Float4 distance_sq = dx * dx + dy * dy + dz * dz;
    store4(distances_sq + at, distance_sq);
    bits |= bitsOf(distance_sq < best.distance_sq) << at;
  }
  for (; bits != 0; bits &= bits - 1) {
    const auto lane = static_cast<std::uint32_t>(std::countr_zero(bits));
    if (distances_sq[lane] >= best.distance_sq) continue;
    const auto index = static_cast<std::uint32_t>(block_index * PointBlock::kPoints + lane);
    if (accept(index)) best = {index, distances_sq[lane]};
  }
}

template <typename Accept>
PointIndex::Found PointIndex::nearest(const Point3f& query, float nearer_than_sq,
                                      const Accept& accept) const {
  Found best{kNone, nearer_than_sq};
  Step steps[kFan * kMaxLevels];
  std::size_t count = 0;
  if (!levels_.empty()) steps[count++] = {0, 0, static_cast<std::uint32_t>(levels_.size() - 1)};
  while (count > 0) {
    const Step step = steps[--count];
    if (step.distance_sq >= best.distance_sq) continue;
    float distances_sq[kFan];
    unsigned bits =
        nearBoxes(levels_[step.level][step.group], query, best.distance_sq, distances_sq);
    if (bits == 0) continue;
    // Into the nearest first: by the time the others come up, few are near enough.
    auto nearest = static_cast<std::uint32_t>(std::countr_zero(bits));
    for (unsigned rest = bits & (bits - 1); rest != 0; rest &= rest - 1) {
      const auto lane = static_cast<std::uint32_t>(std::countr_zero(rest));
      nearest = distances_sq[lane] < distances_sq[nearest] ? lane : nearest;
    }
    const auto first_child = static_cast<std::uint32_t>(step.group * kFan);
    if (step.level == 0) searchBlock(first_child + nearest, query, accept, best);
    for (bits &= ~(1U << nearest); bits != 0; bits &= bits - 1) {
      const auto lane = static_cast<std::uint32_t>(std::countr_zero(bits));
      if (step.level > 0) {
        steps[count++] = {distances_sq[lane], first_child + lane, step.level - 1};
      } else if (distances_sq[lane] < best.distance_sq) {
        searchBlock(first_child + lane, query, accept, best);
      }
    }
    if (step.level > 0) {
      steps[count++] = {distances_sq[nearest], first_child + nearest, step.level - 1};
    }
  }
  return best;
}

template <typename Visit>
void PointIndex::visitNear(const Point3f& query, float nearer_than_sq, const Visit& visit) const {
  Step steps[kFan * kMaxLevels];
  std::size_t count = 0;
  if (!levels_.empty()) steps[count++] = {0, 0, static_cast<std::uint32_t>(levels_.size() - 1)};
  while (count > 0) {
    const Step step = steps[--count];
    float distances_sq[kFan];
    unsigned bits = nearBoxes(levels_[step.level][step.group], query, nearer_than_sq, distances_sq);
    for (; bits != 0; bits &= bits - 1) {
      const auto lane = static_cast<std::uint32_t>(std::countr_zero(bits));
      const auto child = static_cast<std::uint32_t>(step.group * kFan + lane);
      if (step.level == 0) {
        visit(blocks_[child]);
      } else {
        steps[count++] = {0, child, step.level - 1};
      }
    }
  }
}

}  // namespace paloc

#pragma once

#include <tbb/task_arena.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "cube_table.h"
#include "lanes4.h"
#include "paloc/core/types.h"
#include "paloc/map/box_group.h"
#include "paloc/map/point_block.h"
#include "paloc/map/point_kernels.h"
#include "prefetch.h"
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

  struct Box {
    Eigen::Vector3f low, high;  ///< m
  };
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

  Box box() const;  ///< about all points; there must be one

  Point3f point(std::uint32_t index) const { return pointAt(blocks_, index); }

  /// The nearest of the points that `accept(index)` holds for, nearer than the given distance; of
  /// several equally near, any one, but always the same.
  template <typename Accept>
  Found nearest(const Point3f& query, float nearer_than_sq, const Accept& accept) const;
  Found nearest(const Point3f& query, float nearer_than_sq) const;

  /// Accepts every point.
  struct AnyPoint {
    bool operator()(std::uint32_t) const { return true; }
    void prefetch(std::size_t) const {}
  };

  /// A search, and what is to be improved upon: the nearest point known, or none within a distance.
  struct Sought {
    Point3f query;
    Found best;
  };
  static constexpr std::size_t kTogether = 16;
  /// As many searches, at most, at once: they take turns, so that while the memory for one comes
  /// another goes on. `accept.prefetch(block)` fetches what accept(index) will need of a block.
  template <typename Accept>
  void searchTogether(std::span<Sought> sought, const Accept& accept) const;

  /// Numbers of blocks, or of groups of eight blocks, with room to look for more. One object serves
  /// one thread.
  struct NearBlocks {
    std::vector<std::uint32_t> numbers, outer;
    std::size_t count = 0;

    Numbers found() const { return {numbers.data(), count}; }
  };
  /// The blocks whose box is nearer than the given distance, in their order.
  void blocksNear(const Point3f& query, float nearer_than_sq, NearBlocks& near) const;
  /// The groups of eight blocks of which a box is nearer than the given distance, and others.
  void groupsNear(const Point3f& query, float nearer_than_sq, NearBlocks& near) const;
  /// The blocks that blocksNear() finds, in groups that hold them all.
  void blocksNear(const NearBlocks& groups, const Point3f& query, float nearer_than_sq,
                  NearBlocks& near) const;
  /// About the group that a block is in.
  Box boxOfGroup(std::size_t block) const;
  const PointBlock* allBlocks() const { return blocks_; }

 private:
  static constexpr std::size_t kFan = BoxGroup::kBoxes;
  static constexpr std::size_t kMaxLevels = 11;  // 8^11 exceeds what 32 bits count

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
  static Box about(const BoxGroup& group);
  void nearIn(std::size_t level, const Numbers& groups, const Point3f& query, float nearer_than_sq,
              NearBlocks& near) const;
  template <typename Item>
  static RawArray<BoxGroup> groupsOver(const Item* items, std::size_t count,
                                       tbb::task_arena& arena);
  template <typename Accept>
  void searchBlock(std::uint32_t block, const Point3f& query, const Accept& accept,
                   Found& best) const;
  void searchRun(const CubeTable::Run& run, const Point3f& query, AnyPoint, Found& best) const;
  template <typename Accept>
  void searchRun(const CubeTable::Run& run, const Point3f& query, const Accept& accept,
                 Found& best) const;
  template <typename Accept>
  void searchCube(const CubeTable::Place& cube, const Point3f& query, const Accept& accept,
                  Found& best) const;
  template <typename Accept>
  void prefetchRun(const CubeTable::Place& cube, const Accept& accept) const;

  const PointKernels* kernels_ = &pointKernels();
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

inline void PointIndex::searchRun(const CubeTable::Run& run, const Point3f& query, AnyPoint,
                                  Found& best) const {
  constexpr std::uint32_t kPoints = PointBlock::kPoints;
  const std::uint32_t first = run.first / kPoints;
  const NearestOf nearest = kernels_->nearest(blocks_ + first, run.last() / kPoints - first + 1,
                                              {query.x, query.y, query.z});
  if (nearest.distance_sq >= best.distance_sq) return;
  best = {first * kPoints + nearest.index, nearest.distance_sq};
}

template <typename Accept>
void PointIndex::searchRun(const CubeTable::Run& run, const Point3f& query, const Accept& accept,
                           Found& best) const {
  constexpr std::uint32_t kPoints = PointBlock::kPoints;
  for (std::uint32_t b = run.first / kPoints; b <= run.last() / kPoints; ++b) {
    searchBlock(b, query, accept, best);
  }
}

template <typename Accept>
void PointIndex::searchCube(const CubeTable::Place& cube, const Point3f& query,
                            const Accept& accept, Found& best) const {
  for (const CubeTable::Run* run = cube.run; run != nullptr; run = cubes_.next(run)) {
    searchRun(*run, query, accept, best);
  }
}

template <typename Accept>
void PointIndex::prefetchRun(const CubeTable::Place& cube, const Accept& accept) const {
  if (cube.run == nullptr) return;
  constexpr std::size_t kLine = 64, kPoints = PointBlock::kPoints;
  const std::size_t first = cube.run->first / kPoints, last = cube.run->last() / kPoints;
  const auto* at = reinterpret_cast<const char*>(blocks_ + first);
  const auto* end = reinterpret_cast<const char*>(blocks_ + last + 1);
  for (; at < end; at += kLine) prefetch(at);
  for (std::size_t b = first; b <= last; ++b) accept.prefetch(b);
}

// The cube of a query mostly holds a point; what is nearer lies in it or in a cube beside it. Where
// that is further off than a cube is wide, the tree tells.
template <typename Accept>
void PointIndex::searchTogether(std::span<Sought> sought, const Accept& accept) const {
  constexpr float kRoundedUp = 1 + 1e-5F;
  const auto edge_sq = static_cast<float>(cubes_.edge() * cubes_.edge());
  std::array<CubeTable::Surroundings, kTogether> about{};
  // Ten kilobytes, of which little is written, and that before it is read.
  // NOLINTNEXTLINE(cppcoreguidelines-pro-type-member-init)
  std::array<CubeTable::Neighbours, kTogether> neighbours;
  std::array<std::size_t, kTogether> counts{};
  for (std::size_t i = 0; i < sought.size(); ++i) {
    about[i] = cubes_.about(sought[i].query);
    cubes_.prefetch(about[i].home);
  }
  for (std::size_t i = 0; i < sought.size(); ++i) {
    cubes_.open(about[i].home);
    prefetchRun(about[i].home, accept);
  }
  for (std::size_t i = 0; i < sought.size(); ++i) {
    Found& best = sought[i].best;
    searchCube(about[i].home, sought[i].query, accept, best);
    const float within_sq = kRoundedUp * std::min(best.distance_sq, edge_sq);
    counts[i] = CubeTable::neighboursWithin(within_sq, about[i], neighbours[i]);
    for (std::size_t k = 0; k < counts[i]; ++k) cubes_.prefetch(neighbours[i][k]);
  }
  for (std::size_t i = 0; i < sought.size(); ++i) {
    for (std::size_t k = 0; k < counts[i]; ++k) {
      cubes_.open(neighbours[i][k]);
      prefetchRun(neighbours[i][k], accept);
    }
  }
  for (std::size_t i = 0; i < sought.size(); ++i) {
    auto& [query, best] = sought[i];
    for (std::size_t k = 0; k < counts[i]; ++k) {
      if (neighbours[i][k].apart_sq > kRoundedUp * best.distance_sq) continue;
      searchCube(neighbours[i][k], query, accept, best);
    }
    if (best.distance_sq <= edge_sq) continue;
    const Found found = nearest(query, best.distance_sq, accept);
    if (found.index != kNone) best = found;
  }
}

}  // namespace paloc

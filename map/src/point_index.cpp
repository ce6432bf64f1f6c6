#include "point_index.h"

#include <algorithm>

#include "parallel_chunks.h"

namespace paloc {
namespace {

constexpr std::size_t kChunk = 4096;

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
RawArray<BoxGroup> PointIndex::groupsOver(const Item* items, std::size_t count,
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

PointIndex::Found PointIndex::nearest(const Point3f& query, float nearer_than_sq) const {
  Sought sought{query, {kNone, nearer_than_sq}};
  if (points_ > 0) searchTogether({&sought, 1}, AnyPoint());
  return sought.best;
}

// What lies near in groups of one level.
void PointIndex::nearIn(std::size_t level, const Numbers& groups, const Point3f& query,
                        float nearer_than_sq, NearBlocks& near) const {
  // Eight more: what is found is written eight at a time.
  const std::size_t room = kFan * (groups.count + 1);
  if (near.numbers.size() < room) near.numbers.resize(room);
  near.count = kernels_->nearBoxes(levels_[level].data(), groups, {query.x, query.y, query.z},
                                   nearer_than_sq, near.numbers.data());
}

// Level by level: while one box is looked at, the memory of the next ones comes.
void PointIndex::groupsNear(const Point3f& query, float nearer_than_sq, NearBlocks& near) const {
  near.numbers.assign(1, 0);  // of the group at the top
  near.count = levels_.empty() ? 0 : 1;
  for (std::size_t level = levels_.size(); level-- > 1;) {
    near.numbers.swap(near.outer);
    nearIn(level, {near.outer.data(), near.count}, query, nearer_than_sq, near);
  }
}

void PointIndex::blocksNear(const NearBlocks& groups, const Point3f& query, float nearer_than_sq,
                            NearBlocks& near) const {
  nearIn(0, groups.found(), query, nearer_than_sq, near);
}

void PointIndex::blocksNear(const Point3f& query, float nearer_than_sq, NearBlocks& near) const {
  groupsNear(query, nearer_than_sq, near);
  if (near.count == 0) return;
  near.numbers.swap(near.outer);
  nearIn(0, {near.outer.data(), near.count}, query, nearer_than_sq, near);
}

std::size_t PointIndex::bytes() const {
  std::size_t sum = block_count_ * sizeof(PointBlock);
  for (const auto& level : levels_) sum += level.size() * sizeof(BoxGroup);
  return sum + cubes_.bytes();
}

PointIndex::Box PointIndex::about(const BoxGroup& group) {
  BoxGroup whole{};
  enclose(group, whole, 0);
  return {{whole.low[0][0], whole.low[1][0], whole.low[2][0]},
          {whole.high[0][0], whole.high[1][0], whole.high[2][0]}};
}

PointIndex::Box PointIndex::box() const { return about(levels_.back()[0]); }

PointIndex::Box PointIndex::boxOfGroup(std::size_t block) const {
  return about(levels_.front()[block / kFan]);
}

}  // namespace paloc

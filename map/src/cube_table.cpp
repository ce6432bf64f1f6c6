#include "cube_table.h"

#include <bit>
#include <cmath>

#include "parallel_chunks.h"

namespace paloc {
namespace {

constexpr std::size_t kChunk = 1U << 15, kSampledChunks = 16;
constexpr double kPointsWanted = 12;  // in a cube, on average
constexpr std::size_t kLeastSlots = 16;

}  // namespace

CubeTable::CubeTable(const PointBlock* blocks, std::size_t points, const Point3f& low,
                     double voxel_m, tbb::task_arena& arena) {
  const auto corner = [voxel_m](float value) {
    return std::floor(static_cast<double>(value) / voxel_m) * voxel_m;
  };
  low_ = {corner(low.x), corner(low.y), corner(low.z)};
  setEdge(voxel_m);
  // The smallest cubes that hold enough, as some of the points tell.
  const std::size_t chunks = chunkCount(points, kChunk);
  const std::size_t step = chunkCount(chunks, kSampledChunks);
  Counts begun{};
  std::size_t sampled = 0;
  for (std::size_t chunk = 0; chunk < chunks; chunk += step) {
    const std::size_t begin = chunk * kChunk, end = std::min(points, begin + kChunk);
    const Counts more = countBegun(blocks, begin, end);
    for (std::size_t level = 0; level < begun.size(); ++level) begun[level] += more[level];
    sampled += end - begin;
  }
  std::size_t level = 0;
  while (level + 1 < begun.size() &&
         static_cast<double>(begun[level]) * kPointsWanted > static_cast<double>(sampled)) {
    ++level;
  }
  setEdge(voxel_m * static_cast<double>(1U << level));
  std::vector<std::vector<Run>> parts(chunks);
  forEachChunk(arena, points, kChunk, [&](std::size_t chunk, std::size_t begin, std::size_t end) {
    parts[chunk] = runsIn(blocks, begin, end);
  });
  fill(parts);
}

CubeTable::Counts CubeTable::countBegun(const PointBlock* blocks, std::size_t begin,
                                        std::size_t end) const {
  Counts differing{};
  Cube before = cubeOf(pointAt(blocks, begin));
  for (std::size_t i = begin + 1; i < end; ++i) {
    const Cube cube = cubeOf(pointAt(blocks, i));
    const std::uint32_t differ =
        (cube[0] ^ before[0]) | (cube[1] ^ before[1]) | (cube[2] ^ before[2]);
    ++differing[std::min<std::size_t>(static_cast<std::size_t>(std::bit_width(differ)),
                                      differing.size() - 1)];
    before = cube;
  }
  // Numbers that differ in `bits` low bits are apart in cubes of fewer bits.
  Counts begun{};
  std::size_t sum = 1;
  for (std::size_t level = begun.size(); level-- > 0;) {
    begun[level] = sum;
    sum += differing[level];
  }
  return begun;
}

std::vector<CubeTable::Run> CubeTable::runsIn(const PointBlock* blocks, std::size_t begin,
                                              std::size_t end) const {
  std::vector<Run> runs;
  for (std::size_t i = begin; i < end; ++i) {
    const std::uint64_t key = keyOf(cubeOf(pointAt(blocks, i)));
    if (runs.empty() || runs.back().cube != key) {
      runs.push_back({key, static_cast<std::uint32_t>(i), 0, 0});
    }
    ++runs.back().count;
  }
  return runs;
}

void CubeTable::fill(const std::vector<std::vector<Run>>& parts) {
  std::size_t count = 0;
  for (const auto& runs : parts) count += runs.size();
  slots_ = RawArray<Run>(std::bit_ceil(std::max(2 * count, kLeastSlots)));
  mask_ = slots_.size() - 1;
  std::fill(slots_.begin(), slots_.end(), Run{kFree, 0, 0, 0});
  for (const auto& runs : parts) {
    for (const Run& run : runs) {
      std::size_t at = slotOf(run.cube);
      for (; slots_[at].cube != kFree; at = (at + 1) & mask_) {
        if (slots_[at].cube == run.cube) slots_[at].more = 1;
      }
      slots_[at] = run;
    }
  }
}

}  // namespace paloc

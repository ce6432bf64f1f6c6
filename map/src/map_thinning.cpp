#include "map_thinning.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <sstream>
#include <vector>

#include "paloc/core/errors.h"
#include "paloc/map/hilbert_curve.h"
#include "parallel_chunks.h"
#include "radix_sort.h"
#include "voxel_key.h"

namespace paloc {
namespace {

constexpr std::size_t kChunk = 65536;
constexpr double kOrderVoxelM = 0.05;  // when nothing is thinned

/// The grid of voxels that a cloud lies in.
struct Grid {
  double x, y, z;  // its lowest corner
  int bits;        // of a voxel's number along an axis
};

struct Box {
  explicit Box(const Point3f& p) : low(p), high(p) {}
  void enclose(const Point3f& p) {
    low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
  }
  Point3f low, high;
};

// The grid about zero, so that a cloud that was thinned already (VoxelAccumulator) falls into the
// same voxels. Throws when a 21-bit number of voxels does not span the cloud.
Grid gridAbout(const PointCloud& cloud, double edge, tbb::task_arena& arena,
               const std::string& name) {
  std::vector<Box> boxes(chunkCount(cloud.size(), kChunk), Box(cloud.points.front()));
  forEachChunk(arena, cloud.size(), kChunk,
               [&](std::size_t chunk, std::size_t begin, std::size_t end) {
                 Box box(cloud.points[begin]);
                 for (std::size_t i = begin; i < end; ++i) box.enclose(cloud.points[i]);
                 boxes[chunk] = box;
               });
  Box whole = boxes.front();
  for (const Box& box : boxes) whole.enclose(box.low), whole.enclose(box.high);
  const Point3f &low = whole.low, &high = whole.high;
  const double span =
      static_cast<double>(std::max(high.x - low.x, std::max(high.y - low.y, high.z - low.z)));
  if (span / edge >= 2 * kVoxelLimit - 2) {
    std::ostringstream message;
    message << name << " spans " << span / 1000 << " km, too much for voxels of " << edge
            << " m: remove stray points or set a larger voxel";
    throw IoError(message.str());
  }
  const auto corner = [edge](float value) {
    return std::floor(static_cast<double>(value) / edge) * edge;
  };
  const auto most = static_cast<std::uint64_t>(span / edge) + 2;  // it begins within a voxel
  return {corner(low.x), corner(low.y), corner(low.z), static_cast<int>(std::bit_width(most))};
}

RawArray<KeyedIndex> sortedKeys(const PointCloud& cloud, double edge, const Grid& grid,
                                tbb::task_arena& arena) {
  RawArray<KeyedIndex> keyed(cloud.size());
  std::vector<std::uint64_t> largest(chunkCount(cloud.size(), kChunk));
  const HilbertCurve curve;
  const double inverse = 1 / edge;
  const auto number = [inverse](float value, double from) {
    return static_cast<std::uint32_t>(std::max(static_cast<double>(value) - from, 0.0) * inverse);
  };
  forEachChunk(
      arena, cloud.size(), kChunk, [&](std::size_t chunk, std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
          const Point3f& p = cloud.points[i];
          keyed[i] = {
              curve.place(number(p.x, grid.x), number(p.y, grid.y), number(p.z, grid.z), grid.bits),
              static_cast<std::uint32_t>(i)};
          largest[chunk] = std::max(largest[chunk], keyed[i].key);
        }
      });
  radixSort(keyed, *std::max_element(largest.begin(), largest.end()), arena);
  return keyed;
}

/// The mean of points that come one after the other.
class Mean {
 public:
  void add(const Point3f& p) {
    x_ += static_cast<double>(p.x);
    y_ += static_cast<double>(p.y);
    z_ += static_cast<double>(p.z);
    ++count_;
  }
  Point3f value() const {
    const double inverse = 1 / static_cast<double>(count_);
    return {static_cast<float>(x_ * inverse), static_cast<float>(y_ * inverse),
            static_cast<float>(z_ * inverse)};
  }

 private:
  double x_ = 0, y_ = 0, z_ = 0;
  std::size_t count_ = 0;
};

/// Items in the order of their keys, of which those of one key become one point, or each does.
class Runs {
 public:
  Runs(const RawArray<KeyedIndex>& keyed, bool merge) : keyed_(keyed), merge_(merge) {}

  bool begins(std::size_t at) const {
    return !merge_ || at == 0 || keyed_[at].key != keyed_[at - 1].key;
  }
  std::size_t countBegun(std::size_t begin, std::size_t end) const {
    std::size_t count = 0;
    for (std::size_t at = begin; at < end; ++at) count += begins(at) ? 1 : 0;
    return count;
  }
  /// Calls put(mean) for each run that begins in [begin, end).
  template <typename Put>
  void forEachMean(const PointCloud& cloud, std::size_t begin, std::size_t end,
                   const Put& put) const {
    std::size_t at = begin;
    while (at < end && !begins(at)) ++at;
    while (at < end) {
      Mean mean;
      do {
        mean.add(cloud.points[keyed_[at++].index]);
      } while (at < keyed_.size() && !begins(at));
      put(mean.value());
    }
  }

 private:
  const RawArray<KeyedIndex>& keyed_;
  bool merge_;
};

void put(const Point3f& point, std::size_t i, RawArray<PointBlock>& blocks) {
  PointBlock& block = blocks[i / PointBlock::kPoints];
  const std::size_t lane = i % PointBlock::kPoints;
  block.x[lane] = point.x, block.y[lane] = point.y, block.z[lane] = point.z;
}

}  // namespace

double curveVoxel(double voxel_m) { return voxel_m > 0 ? voxel_m : kOrderVoxelM; }

BlockedPoints thinAlongCurve(const PointCloud& cloud, double voxel_m, tbb::task_arena& arena,
                             const std::string& name) {
  const double edge = curveVoxel(voxel_m);
  const RawArray<KeyedIndex> keyed =
      sortedKeys(cloud, edge, gridAbout(cloud, edge, arena, name), arena);
  const Runs runs(keyed, voxel_m > 0);
  std::vector<std::size_t> starts(chunkCount(keyed.size(), kChunk) + 1);
  forEachChunk(arena, keyed.size(), kChunk,
               [&](std::size_t chunk, std::size_t begin, std::size_t end) {
                 starts[chunk + 1] = runs.countBegun(begin, end);
               });
  std::partial_sum(starts.begin(), starts.end(), starts.begin());
  BlockedPoints kept;
  kept.count = starts.back();
  kept.blocks = RawArray<PointBlock>(chunkCount(kept.count, PointBlock::kPoints));
  forEachChunk(arena, keyed.size(), kChunk,
               [&](std::size_t chunk, std::size_t begin, std::size_t end) {
                 std::size_t at = starts[chunk];
                 runs.forEachMean(cloud, begin, end,
                                  [&](const Point3f& mean) { put(mean, at++, kept.blocks); });
               });
  constexpr Point3f kMissing{PointBlock::kMissing, PointBlock::kMissing, PointBlock::kMissing};
  for (std::size_t i = kept.count; i % PointBlock::kPoints != 0; ++i) put(kMissing, i, kept.blocks);
  return kept;
}

}  // namespace paloc

#include "map_thinning.h"

#include <tbb/parallel_sort.h>

#include <algorithm>
#include <cstdint>
#include <sstream>
#include <utility>

#include "paloc/core/errors.h"
#include "parallel_chunks.h"
#include "voxel_key.h"

namespace paloc {
namespace {

constexpr std::size_t kChunk = 65536;
constexpr double kOrderEdgeM = 0.05;  // of the curve's voxels when nothing is thinned

struct Keyed {
  std::uint64_t key;
  std::uint32_t index;
  bool operator<(const Keyed& other) const {
    return key != other.key ? key < other.key : index < other.index;
  }
};

struct Corner {
  float x, y, z;
};

// The lowest corner of the cloud; throws when a 21-bit number of voxels does not span it.
Corner lowCorner(const PointCloud& cloud, double edge, const std::string& name) {
  Point3f low = cloud.points.front(), high = low;
  for (const Point3f& p : cloud.points) {
    low.x = std::min(low.x, p.x), high.x = std::max(high.x, p.x);
    low.y = std::min(low.y, p.y), high.y = std::max(high.y, p.y);
    low.z = std::min(low.z, p.z), high.z = std::max(high.z, p.z);
  }
  const double span =
      static_cast<double>(std::max(high.x - low.x, std::max(high.y - low.y, high.z - low.z)));
  if (span / edge >= 2 * kVoxelLimit - 2) {
    std::ostringstream message;
    message << name << " spans " << span / 1000 << " km, too much for voxels of " << edge
            << " m: remove stray points or set a larger voxel";
    throw IoError(message.str());
  }
  return {low.x, low.y, low.z};
}

std::vector<Keyed> sortedKeys(const PointCloud& cloud, double edge, const Corner& low,
                              tbb::task_arena& arena) {
  std::vector<Keyed> keyed(cloud.size());
  const double inverse = 1 / edge;
  const auto number = [inverse](float value, float from) {
    return static_cast<std::uint64_t>((static_cast<double>(value) - static_cast<double>(from)) *
                                      inverse);
  };
  forEachChunk(arena, cloud.size(), kChunk, [&](std::size_t, std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const Point3f& p = cloud.points[i];
      keyed[i] = {mortonKey(number(p.x, low.x), number(p.y, low.y), number(p.z, low.z)),
                  static_cast<std::uint32_t>(i)};
    }
  });
  arena.execute([&] { tbb::parallel_sort(keyed.begin(), keyed.end()); });
  return keyed;
}

}  // namespace

std::vector<Point3f> thinAlongMortonCurve(const PointCloud& cloud, double voxel_m,
                                          tbb::task_arena& arena, const std::string& name) {
  const double edge = voxel_m > 0 ? voxel_m : kOrderEdgeM;
  const std::vector<Keyed> keyed = sortedKeys(cloud, edge, lowCorner(cloud, edge, name), arena);
  std::vector<Point3f> kept;
  kept.reserve(cloud.size());
  for (std::size_t begin = 0, end = 0; begin < keyed.size(); begin = end) {
    double x = 0, y = 0, z = 0;
    end = begin;
    do {
      const Point3f& p = cloud.points[keyed[end].index];
      x += static_cast<double>(p.x);
      y += static_cast<double>(p.y);
      z += static_cast<double>(p.z);
      ++end;
    } while (voxel_m > 0 && end < keyed.size() && keyed[end].key == keyed[begin].key);
    const double inverse = 1 / static_cast<double>(end - begin);
    kept.push_back({static_cast<float>(x * inverse), static_cast<float>(y * inverse),
                    static_cast<float>(z * inverse)});
  }
  return kept;
}

}  // namespace paloc

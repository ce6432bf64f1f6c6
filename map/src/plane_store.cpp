#include "plane_store.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numeric>

#include "parallel_chunks.h"

namespace paloc {
namespace {

constexpr std::size_t kSampled = 16384;  // points, to tell the share that has a plane
constexpr std::size_t kTrusted = 100;    // planes among these, for an estimate
constexpr std::size_t kChunk = 256;

}  // namespace

PlaneStore::PlaneStore(std::span<const Point3f> points, const KdTree& tree,
                       const MapSettings& settings)
    : points_(points),
      tree_(tree),
      neighbours_(static_cast<std::size_t>(std::max(settings.plane_neighbours, 3))),
      limits_{.max_thickness_m = settings.plane_max_thickness_m},
      max_radius_sq_(static_cast<float>(settings.plane_max_radius_m * settings.plane_max_radius_m)),
      bytes_(std::make_unique_for_overwrite<std::byte[]>(points.size() * sizeof(MapPlane))),
      states_(std::make_unique<std::atomic<State>[]>(points.size())) {}

MapPlane PlaneStore::fit(std::uint32_t index) const {
  thread_local std::vector<std::uint32_t> indices;
  thread_local std::vector<float> distances, scratch;
  thread_local std::vector<Point3f> relative;
  indices.resize(neighbours_);
  distances.resize(neighbours_);
  scratch.resize(neighbours_);
  relative.resize(neighbours_);
  const Point3f& p = points_[index];
  const std::size_t found = tree_.knnSearch(&p.x, neighbours_, indices.data(), distances.data());
  std::size_t count = 0;
  while (count < found && distances[count] <= max_radius_sq_) {
    const Point3f& q = points_[indices[count]];
    relative[count++] = {q.x - p.x, q.y - p.y, q.z - p.z};
  }
  const float radius = std::sqrt(distances[count > 0 ? count - 1 : 0]);
  return fitPlane({relative.data(), count}, radius, limits_, scratch);
}

MapPlane PlaneStore::at(std::uint32_t index) const {
  std::byte* const place = bytes_.get() + index * sizeof(MapPlane);
  MapPlane plane;
  if (states_[index].load(std::memory_order_acquire) == kReady) {
    std::memcpy(&plane, place, sizeof plane);
    return plane;
  }
  plane = fit(index);
  // One thread writes it down; another that fitted it meanwhile got the same.
  State expected = kMissing;
  if (states_[index].compare_exchange_strong(expected, kBeingWritten, std::memory_order_relaxed)) {
    std::memcpy(place, &plane, sizeof plane);
    states_[index].store(kReady, std::memory_order_release);
  }
  return plane;
}

std::size_t PlaneStore::countEvery(std::size_t stride, tbb::task_arena& arena) const {
  const std::size_t looked_at = (points_.size() + stride - 1) / stride;
  std::vector<std::size_t> planar(chunkCount(looked_at, kChunk));
  forEachChunk(arena, looked_at, kChunk,
               [&](std::size_t chunk, std::size_t begin, std::size_t end) {
                 for (std::size_t i = begin; i < end; ++i) {
                   planar[chunk] += at(static_cast<std::uint32_t>(i * stride)).planar();
                 }
               });
  return std::accumulate(planar.begin(), planar.end(), std::size_t{0});
}

std::size_t PlaneStore::countPlanar(tbb::task_arena& arena) const {
  const std::size_t stride = std::max<std::size_t>(points_.size() / kSampled, 1);
  const std::size_t planar = countEvery(stride, arena);
  if (stride == 1) return planar;
  if (planar < kTrusted) return countEvery(1, arena);
  const std::size_t looked_at = (points_.size() + stride - 1) / stride;
  return static_cast<std::size_t>(static_cast<double>(planar) / static_cast<double>(looked_at) *
                                  static_cast<double>(points_.size()));
}

}  // namespace paloc

#pragma once

#include <tbb/task_arena.h>

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "kd_tree.h"
#include "paloc/map/map_plane.h"
#include "paloc/map/map_settings.h"

namespace paloc {

/// The plane about each point of a map, fitted when it is first asked for. A plane depends on the
/// map and the settings alone, so whichever thread fits it, its bytes are the same. May be asked
/// from any thread; no thread waits for another.
class PlaneStore {
 public:
  /// Keeps references to the points and their tree.
  PlaneStore(std::span<const Point3f> points, const KdTree& tree, const MapSettings& settings);

  MapPlane at(std::uint32_t index) const;

  /// How many points have a plane: counted up to some ten thousand points, beyond that estimated
  /// from every n-th point (at least that many), unless these show next to no planes.
  std::size_t countPlanar(tbb::task_arena& arena) const;

 private:
  enum State : std::uint8_t { kMissing, kBeingWritten, kReady };

  MapPlane fit(std::uint32_t index) const;
  std::size_t countEvery(std::size_t stride, tbb::task_arena& arena) const;

  std::span<const Point3f> points_;
  const KdTree& tree_;
  std::size_t neighbours_;
  PlaneFitLimits limits_;
  float max_radius_sq_;
  // Not initialized: memory for planes that are never asked for is never touched.
  std::unique_ptr<std::byte[]> bytes_;
  std::unique_ptr<std::atomic<State>[]> states_;
};

}  // namespace paloc

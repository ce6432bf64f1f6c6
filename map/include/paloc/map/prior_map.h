#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <memory>
#include <string>

#include "paloc/core/export.h"
#include "paloc/core/types.h"
#include "paloc/map/map_plane.h"
#include "paloc/map/map_settings.h"
#include "paloc/map/point_cloud.h"

namespace paloc {

/// The map that scans are registered to: a cloud, thinned once, with a search tree and the plane
/// about each of its points, fitted when it is first asked for, and kept: a recording sees a part
/// of its map only. To its user immutable: every query may be made from any thread, and the same
/// cloud and settings give the same answers, on any number of threads and in any order of queries.
class PALOC_EXPORT PriorMap {
 public:
  static constexpr std::uint32_t kNoPoint = std::numeric_limits<std::uint32_t>::max();

  /// What a search found: the nearest map point, or kNoPoint.
  struct Nearest {
    std::uint32_t index = kNoPoint;
    float distance_sq = 0;  ///< m2
    bool found() const { return index != kNoPoint; }
  };

  /// What the map is made of, for reports.
  struct Statistics {
    std::size_t points_read = 0;  ///< before thinning
    std::size_t nonfinite = 0;    ///< points of the file left out for that
    std::size_t points = 0;       ///< after
    std::size_t planar = 0;  ///< of these, with a plane: of a large map, estimated from a sample
    Vec3 low = Vec3::Zero(), high = Vec3::Zero();  ///< bounding box in the map frame (m)
    double sort_s = 0, index_s = 0, planes_s = 0;  ///< time of thinning, tree, first planes
  };

  /// Reads a cloud (see loadCloud) and builds the map. Throws IoError in one sentence.
  static std::shared_ptr<const PriorMap> load(const std::filesystem::path& file,
                                              const MapSettings& settings);

  /// Builds the map from a cloud; `name` is what errors call it. Throws IoError when the cloud
  /// holds fewer than 100 points, fewer than 20 points with a plane, or spans more than 2^21
  /// voxels.
  static std::shared_ptr<const PriorMap> build(const PointCloud& cloud, const MapSettings& settings,
                                               const std::string& name = "the prior map");

  ~PriorMap();
  PriorMap(const PriorMap&) = delete;
  PriorMap& operator=(const PriorMap&) = delete;

  std::size_t size() const;
  /// Origin of the local frame (m, in the map frame): p_map = origin + p_local. Points and queries
  /// are local, so that UTM coordinates keep their millimetres.
  const Vec3& origin() const;
  const Point3f& point(std::uint32_t index) const;  ///< local
  /// The first time 5 to 10 us (a search for its neighbours and a fit), then at once.
  MapPlane plane(std::uint32_t index) const;
  const Statistics& statistics() const;

  /// The nearest map point to a local position within a distance (m); of several equally near, any
  /// one, but always the same.
  Nearest nearest(const Point3f& local, float max_distance_m) const;

 private:
  struct Data;
  explicit PriorMap(std::unique_ptr<const Data> data);
  std::unique_ptr<const Data> data_;
};

}  // namespace paloc

#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <limits>
#include <memory>
#include <span>
#include <string>

#include "paloc/core/export.h"
#include "paloc/core/types.h"
#include "paloc/map/map_plane.h"
#include "paloc/map/map_settings.h"
#include "paloc/map/point_cloud.h"

namespace paloc {

/// The map that scans are registered to: a cloud, thinned once, with an index and the plane about
/// each of its points. Immutable: every query may be made from any thread, and the same cloud and
/// settings give the same answers, on any number of threads, prepared now or read from the side
/// file.
class PALOC_EXPORT PriorMap {
 public:
  static constexpr std::uint32_t kNoPoint = std::numeric_limits<std::uint32_t>::max();

  /// What a search found: the nearest map point, or kNoPoint.
  struct Nearest {
    std::uint32_t index = kNoPoint;
    float distance_sq = 0;  ///< m2
    bool found() const { return index != kNoPoint; }
  };

  /// What became of the side file: nothing (switched off, or the map is from no file), it was
  /// read, (re)written, or could not be written.
  enum class SideFile { kNone, kRead, kWritten, kNotWritten };

  /// What the map is made of, for reports.
  struct Statistics {
    std::size_t points_read = 0;                   ///< before thinning
    std::size_t nonfinite = 0;                     ///< points of the file left out for that
    std::size_t points = 0;                        ///< after
    std::size_t planar = 0;                        ///< of these, with a plane
    Vec3 low = Vec3::Zero(), high = Vec3::Zero();  ///< bounding box in the map frame (m)
    std::size_t bytes = 0;                         ///< of memory for points, index and planes
    double sort_s = 0, index_s = 0, planes_s = 0;  ///< time of thinning, index, planes
    SideFile side_file = SideFile::kNone;
    std::string side_file_note;  ///< why one could not be used or written; empty: all went well
    double side_file_s = 0;      ///< time of checking, reading and writing it
  };

  /// Called now and then while the file is read, with what is done of that, 0..1.
  using Progress = std::function<void(double share)>;

  /// Reads a cloud (see loadCloud), thinning it on the way, and builds the map; or reads what was
  /// prepared from the same file content with the same settings before, from the side file
  /// `FILE.paloc`. One that does not fit or is damaged is replaced; that none can be written is no
  /// error (see Statistics). Throws IoError in one sentence, also when the machine has not the
  /// memory for it.
  static std::shared_ptr<const PriorMap> load(const std::filesystem::path& file,
                                              const MapSettings& settings,
                                              const Progress& progress = {});

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
  Point3f point(std::uint32_t index) const;  ///< local
  MapPlane plane(std::uint32_t index) const;
  const Statistics& statistics() const;

  /// The nearest map point to a local position within a distance (m); of several equally near, any
  /// one, but always the same.
  Nearest nearest(const Point3f& local, float max_distance_m) const;

  struct Query {
    Point3f local;
    std::uint32_t hint = kNoPoint;  ///< a map point that may be near; it saves time
  };
  /// The same for many positions, among those map points that can be seen from `viewer` (local):
  /// not on the far face of a thin wall (MapPlane::oriented). Where all are far faces, the nearest
  /// of them. Together they take less time than one by one.
  void nearestSeenFrom(const Point3f& viewer, float max_distance_m, std::span<const Query> queries,
                       std::span<Nearest> answers) const;

 private:
  struct Data;
  explicit PriorMap(std::unique_ptr<const Data> data);
  static std::unique_ptr<Data> prepare(const PointCloud& cloud, const MapSettings& settings,
                                       const std::string& name);
  std::unique_ptr<const Data> data_;
};

}  // namespace paloc

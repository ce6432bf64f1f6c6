#include "paloc/map/prior_map.h"

#include <tbb/task_arena.h>

#include <algorithm>
#include <chrono>
#include <cmath>

#include "kd_tree.h"
#include "map_thinning.h"
#include "paloc/core/errors.h"
#include "paloc/map/cloud_io.h"
#include "plane_store.h"

namespace paloc {
namespace {

constexpr std::size_t kMinPoints = 100;
constexpr std::size_t kMinPlanes = 20;
constexpr std::size_t kLeafPoints = 10;

class Stopwatch {
 public:
  double seconds() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  }

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

}  // namespace

struct PriorMap::Data {
  Vec3 origin = Vec3::Zero();
  std::vector<Point3f> points;
  PointAdaptor adaptor{points};
  std::unique_ptr<KdTree> tree;
  std::unique_ptr<PlaneStore> planes;
  Statistics statistics;
};

namespace {

void describe(PriorMap::Statistics& statistics, const Vec3& origin,
              const std::vector<Point3f>& points) {
  Eigen::Vector3f low(points[0].x, points[0].y, points[0].z), high = low;
  for (const Point3f& p : points) {
    const Eigen::Vector3f v(p.x, p.y, p.z);
    low = low.cwiseMin(v);
    high = high.cwiseMax(v);
  }
  statistics.low = origin + low.cast<double>();
  statistics.high = origin + high.cast<double>();
  statistics.points = points.size();
}

}  // namespace

std::shared_ptr<const PriorMap> PriorMap::load(const std::filesystem::path& file,
                                               const MapSettings& settings) {
  return build(loadCloud(file), settings, file.string());
}

std::shared_ptr<const PriorMap> PriorMap::build(const PointCloud& cloud,
                                                const MapSettings& settings,
                                                const std::string& name) {
  if (cloud.size() < kMinPoints) {
    throw IoError(name + " holds " + std::to_string(cloud.size()) +
                  " points: a prior map needs at least " + std::to_string(kMinPoints));
  }
  tbb::task_arena arena(std::max(settings.threads, 1));
  auto data = std::make_unique<Data>();
  data->origin = cloud.origin;
  data->statistics.points_read = cloud.size();
  data->statistics.nonfinite = cloud.nonfinite_dropped;
  const Stopwatch sorting;
  data->points = thinAlongMortonCurve(cloud, settings.voxel_m, arena, name);
  data->statistics.sort_s = sorting.seconds();
  const Stopwatch indexing;
  data->tree = std::make_unique<KdTree>(3, data->adaptor,
                                        nanoflann::KDTreeSingleIndexAdaptorParams(kLeafPoints));
  data->statistics.index_s = indexing.seconds();
  const Stopwatch fitting;
  data->planes = std::make_unique<PlaneStore>(data->points, *data->tree, settings);
  data->statistics.planar = data->planes->countPlanar(arena);
  data->statistics.planes_s = fitting.seconds();
  describe(data->statistics, data->origin, data->points);
  if (data->statistics.planar < kMinPlanes) {
    throw IoError(name + " holds no surface: of its " + std::to_string(data->points.size()) +
                  " points (thinned), " + std::to_string(data->statistics.planar) +
                  " lie on a plane");
  }
  return std::shared_ptr<const PriorMap>(new PriorMap(std::move(data)));
}

PriorMap::PriorMap(std::unique_ptr<const Data> data) : data_(std::move(data)) {}
PriorMap::~PriorMap() = default;

std::size_t PriorMap::size() const { return data_->points.size(); }
const Vec3& PriorMap::origin() const { return data_->origin; }
const Point3f& PriorMap::point(std::uint32_t index) const { return data_->points[index]; }
MapPlane PriorMap::plane(std::uint32_t index) const { return data_->planes->at(index); }
const PriorMap::Statistics& PriorMap::statistics() const { return data_->statistics; }

PriorMap::Nearest PriorMap::nearest(const Point3f& local, float max_distance_m) const {
  NearestResult result{max_distance_m * max_distance_m};
  data_->tree->findNeighbors(result, &local.x, nanoflann::SearchParams());
  if (result.index == kNoPoint) return {};
  return {result.index, result.distance_sq};
}

}  // namespace paloc

#include "paloc/map/prior_map.h"

#include <tbb/task_arena.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "map_side_file.h"
#include "map_thinning.h"
#include "memory_budget.h"
#include "paloc/core/errors.h"
#include "paloc/core/text.h"
#include "paloc/map/cloud_io.h"
#include "plane_fitter.h"
#include "plane_store.h"
#include "point_index.h"
#include "point_vector.h"
#include "prefetch.h"
#include "stopwatch.h"

namespace paloc {
namespace {

constexpr std::size_t kMinPoints = 100;
constexpr std::size_t kMinPlanes = 20;

}  // namespace

struct PriorMap::Data {
  PreparedMap map;
  PointIndex index;  // refers to it
  Statistics statistics;

  void nearestSeen(const Point3f& viewer, float max_distance_sq, std::span<const Query> queries,
                   std::span<Nearest> answers) const;
};

namespace {

/// Accepts points that can be seen from somewhere.
class SeenPoints {
 public:
  SeenPoints(const PointIndex& index, const PlaneStore& planes, const Point3f& viewer)
      : index_(index), planes_(planes), viewer_(toVec3f(viewer)) {}

  bool operator()(std::uint32_t i) const {
    return !planes_[i].oriented() ||
           planes_[i].normal().dot(viewer_ - toVec3f(index_.point(i))) > 0;
  }
  void prefetch(std::size_t block) const {
    const PackedPlane* const planes = planes_.data() + block * PointBlock::kPoints;
    paloc::prefetch(planes);
    paloc::prefetch(planes + PointBlock::kPoints / 2);
  }

 private:
  const PointIndex& index_;
  const PlaneStore& planes_;
  Eigen::Vector3f viewer_;
};

// What ordering takes, and then the index and the planes, on top of the points themselves.
void requireMemory(std::size_t points, const std::string& name) {
  constexpr std::size_t kSortBytes = 2 * 16 + sizeof(Point3f);
  constexpr std::size_t kMapBytes = 2 * sizeof(Point3f) + sizeof(PackedPlane);
  MemoryBudget().require(points * std::max(kSortBytes, kMapBytes),
                         text(name, ": a prior map of its ", points, " points"));
}

std::uint64_t countPlanar(const PlaneStore& planes) {
  std::uint64_t planar = 0;
  for (std::size_t i = 0; i < planes.size(); ++i) planar += planes[i].planar();
  return planar;
}

void describe(const PreparedMap& map, const PointIndex& index, PriorMap::Statistics& statistics) {
  const PointIndex::Box box = index.box();
  statistics.low = map.origin + box.low.cast<double>();
  statistics.high = map.origin + box.high.cast<double>();
  statistics.points_read = map.points_read;
  statistics.nonfinite = map.nonfinite;
  statistics.points = map.points;
  statistics.planar = map.planar;
  statistics.bytes = index.bytes() + map.planes.size() * sizeof(PackedPlane);
}

}  // namespace

// Orders, indexes and fits.
std::unique_ptr<PriorMap::Data> PriorMap::prepare(const PointCloud& cloud,
                                                  const MapSettings& settings,
                                                  const std::string& name) {
  if (cloud.size() < kMinPoints) {
    throw IoError(
        text(name, " holds ", cloud.size(), " points: a prior map needs at least ", kMinPoints));
  }
  requireMemory(cloud.size(), name);
  tbb::task_arena arena(std::max(settings.threads, 1));
  auto data = std::make_unique<Data>();
  PreparedMap& map = data->map;
  const Stopwatch sorting;
  BlockedPoints points = thinAlongCurve(cloud, settings.voxel_m, arena, name);
  map.blocks = std::move(points.blocks);
  map.points = points.count;
  data->statistics.sort_s = sorting.seconds();
  const Stopwatch indexing;
  data->index = PointIndex(map.blocks, map.points, curveVoxel(settings.voxel_m), arena);
  data->statistics.index_s = indexing.seconds();
  const Stopwatch fitting;
  map.planes = fitPlanes(data->index, settings, arena);
  data->statistics.planes_s = fitting.seconds();
  map.origin = cloud.origin;
  map.points_read = std::max(cloud.points_read, cloud.size());
  map.nonfinite = cloud.nonfinite_dropped;
  map.planar = countPlanar(map.planes);
  describe(map, data->index, data->statistics);
  if (map.planar < kMinPlanes) {
    throw IoError(text(name, " holds no surface: of its ", map.points, " points (thinned), ",
                       map.planar, " lie on a plane"));
  }
  return data;
}

std::shared_ptr<const PriorMap> PriorMap::build(const PointCloud& cloud,
                                                const MapSettings& settings,
                                                const std::string& name) {
  return std::shared_ptr<const PriorMap>(new PriorMap(prepare(cloud, settings, name)));
}

std::shared_ptr<const PriorMap> PriorMap::load(const std::filesystem::path& file,
                                               const MapSettings& settings,
                                               const Progress& progress) {
  const LoadOptions reading_options{.voxel_m = settings.voxel_m, .progress = progress};
  if (!settings.side_file) return build(loadCloud(file, reading_options), settings, file.string());
  tbb::task_arena arena(std::max(settings.threads, 1));
  const Stopwatch reading;
  MapSideFile side_file(file, settings, arena);
  std::unique_ptr<Data> data;
  if (std::optional<PreparedMap> prepared = side_file.read()) {
    const double read_s = reading.seconds();
    const Stopwatch indexing;
    data = std::make_unique<Data>();
    data->map = std::move(*prepared);
    data->index =
        PointIndex(data->map.blocks, data->map.points, curveVoxel(settings.voxel_m), arena);
    data->statistics.index_s = indexing.seconds();
    describe(data->map, data->index, data->statistics);
    data->statistics.side_file = SideFile::kRead;
    data->statistics.side_file_s = read_s;
  } else {
    const double checked_s = reading.seconds();
    data = prepare(loadCloud(file, reading_options), settings, file.string());
    const Stopwatch writing;
    Statistics& statistics = data->statistics;
    statistics.side_file_note = side_file.problem();
    const bool written = side_file.write(data->map);
    statistics.side_file = written ? SideFile::kWritten : SideFile::kNotWritten;
    if (!written) statistics.side_file_note = side_file.problem();
    statistics.side_file_s = checked_s + writing.seconds();
  }
  return std::shared_ptr<const PriorMap>(new PriorMap(std::move(data)));
}

PriorMap::PriorMap(std::unique_ptr<const Data> data) : data_(std::move(data)) {}
PriorMap::~PriorMap() = default;

std::size_t PriorMap::size() const { return data_->index.size(); }
const Vec3& PriorMap::origin() const { return data_->map.origin; }
Point3f PriorMap::point(std::uint32_t index) const { return data_->index.point(index); }
MapPlane PriorMap::plane(std::uint32_t index) const { return data_->map.planes[index].unpacked(); }
const PriorMap::Statistics& PriorMap::statistics() const { return data_->statistics; }

namespace {

PriorMap::Nearest nearestOf(const PointIndex::Found& found) {
  if (found.index == PointIndex::kNone) return {};
  return {found.index, found.distance_sq};
}

}  // namespace

// Of no more searches than can take turns. Most find a point that is seen at once; only for the
// others the planes of all points about are looked at.
void PriorMap::Data::nearestSeen(const Point3f& viewer, float max_distance_sq,
                                 std::span<const Query> queries, std::span<Nearest> answers) const {
  std::array<PointIndex::Sought, PointIndex::kTogether> sought;
  const std::span searches(sought.data(), queries.size());
  for (std::size_t i = 0; i < queries.size(); ++i) {
    const auto& [local, hint] = queries[i];
    sought[i] = {local, {PointIndex::kNone, max_distance_sq}};
    if (hint == kNoPoint) continue;
    const float distance_sq = (toVec3f(index.point(hint)) - toVec3f(local)).squaredNorm();
    if (distance_sq < max_distance_sq) sought[i].best = {hint, distance_sq};
  }
  index.searchTogether(searches, PointIndex::AnyPoint());
  for (std::size_t i = 0; i < queries.size(); ++i) {
    answers[i] = nearestOf(sought[i].best);
    if (answers[i].found()) paloc::prefetch(&map.planes[answers[i].index]);
  }
  const SeenPoints seen(index, map.planes, viewer);
  std::array<std::size_t, PointIndex::kTogether> unseen{};
  std::size_t count = 0;
  for (std::size_t i = 0; i < queries.size(); ++i) {
    if (!answers[i].found() || seen(answers[i].index)) continue;
    sought[count] = {queries[i].local, {PointIndex::kNone, max_distance_sq}};
    unseen[count++] = i;
  }
  index.searchTogether(searches.first(count), seen);
  for (std::size_t k = 0; k < count; ++k) {
    const Nearest nearest = nearestOf(sought[k].best);
    if (nearest.found()) answers[unseen[k]] = nearest;
  }
}

PriorMap::Nearest PriorMap::nearest(const Point3f& local, float max_distance_m) const {
  return nearestOf(data_->index.nearest(local, max_distance_m * max_distance_m));
}

// In groups whose searches take turns.
void PriorMap::nearestSeenFrom(const Point3f& viewer, float max_distance_m,
                               std::span<const Query> queries, std::span<Nearest> answers) const {
  constexpr std::size_t kGroup = PointIndex::kTogether;
  for (std::size_t begin = 0; begin < queries.size(); begin += kGroup) {
    const std::size_t count = std::min(kGroup, queries.size() - begin);
    data_->nearestSeen(viewer, max_distance_m * max_distance_m, queries.subspan(begin, count),
                       answers.subspan(begin, count));
  }
}

}  // namespace paloc

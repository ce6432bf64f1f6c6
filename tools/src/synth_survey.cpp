#include "paloc/tools/synth_survey.h"

#include <tbb/parallel_for.h>

#include <cmath>
#include <numbers>

#include "paloc/tools/synth_random.h"

namespace paloc::synth {
namespace {

constexpr double kDegree = std::numbers::pi / 180;

struct MapPoint {
  Point3f position;
  float intensity = 0;
  float lot = 0;  // of the points in a voxel, that with the lowest is kept
};

/// The voxels that hold a point: a hash table with open addressing.
class Voxels {
 public:
  struct Voxel {
    std::uint64_t key = kEmpty;
    float lot = 0;  // of the point that it keeps
    std::uint32_t point = 0;
  };

  explicit Voxels(double edge) : edge_(edge), slots_(1U << 20U) {}

  /// The voxel of the point; of a new one, only the key is set.
  Voxel& at(const Point3f& p, bool& is_new) {
    if (2 * used_ > slots_.size()) grow();
    const std::uint64_t key = keyOf(p);
    Voxel& voxel = find(key);
    is_new = voxel.key == kEmpty;
    if (is_new) ++used_;
    voxel.key = key;
    return voxel;
  }

 private:
  static constexpr std::uint64_t kEmpty = ~0ULL;

  std::uint64_t keyOf(const Point3f& p) const {
    const auto cell = [&](float v) {  // 21 bits each: +-26 km at 2.5 cm
      return static_cast<std::uint64_t>(std::llround(std::floor(v / edge_)) + (1 << 20)) &
             0x1fffffU;
    };
    return cell(p.x) << 42U | cell(p.y) << 21U | cell(p.z);
  }

  Voxel& find(std::uint64_t key) {
    const std::size_t mask = slots_.size() - 1;
    std::size_t at = (key * 0x9e3779b97f4a7c15ULL >> 20U) & mask;
    while (slots_[at].key != kEmpty && slots_[at].key != key) at = (at + 1) & mask;
    return slots_[at];
  }

  void grow() {
    std::vector<Voxel> old(2 * slots_.size());
    old.swap(slots_);
    for (const Voxel& voxel : old) {
      if (voxel.key != kEmpty) find(voxel.key) = voxel;
    }
  }

  double edge_;
  std::size_t used_ = 0;
  std::vector<Voxel> slots_;
};

/// Keeps one point a voxel, drawn by lot: the first that a sweep comes to would be the one that its
/// noise moved towards the sweep, and on a surface seen aslant that is off it to one side.
void keep(const MapPoint& point, Voxels& voxels, PointCloud& cloud) {
  bool is_new = false;
  Voxels::Voxel& voxel = voxels.at(point.position, is_new);
  if (!is_new && voxel.lot <= point.lot) return;
  voxel.lot = point.lot;
  if (is_new) {
    voxel.point = static_cast<std::uint32_t>(cloud.points.size());
    cloud.points.emplace_back();
    cloud.intensity.push_back(0);
  }
  cloud.points[voxel.point] = point.position;
  cloud.intensity[voxel.point] = point.intensity;
}

/// One vertical sweep of the scanner from a station.
std::vector<MapPoint> sweep(const SurveyModel& model, const SceneMesh& mesh,
                            const Raycaster& raycaster, const std::vector<double>& surface_bias,
                            const Vec3& station, double azimuth, RandomStream random,
                            RandomStream lots) {
  const int rows = static_cast<int>((90 - model.lowest_elevation_deg) / model.angular_step_deg);
  std::vector<Eigen::Vector3f> directions;
  for (int row = 0; row < rows; ++row) {
    const double elevation = (model.lowest_elevation_deg + row * model.angular_step_deg) * kDegree;
    directions.push_back(Vec3(std::cos(elevation) * std::cos(azimuth),
                              std::cos(elevation) * std::sin(azimuth), std::sin(elevation))
                             .cast<float>());
  }
  std::vector<RayHit> hits(directions.size());
  raycaster.cast(station, directions, hits);
  std::vector<MapPoint> points;
  constexpr float kGrazing = 0.087F;
  for (std::size_t i = 0; i < hits.size(); ++i) {
    const RayHit& hit = hits[i];
    const float cos_incidence = std::abs(hit.normal_scene.dot(directions[i]));
    if (!hit.valid() || hit.distance_m < model.min_range_m || hit.distance_m > model.max_range_m ||
        cos_incidence < kGrazing) {
      continue;
    }
    const double range = hit.distance_m + model.range_noise_m * random.normal();
    const Vec3 p = station + range * directions[i].cast<double>() +
                   surface_bias[hit.surface] * hit.normal_scene.cast<double>();
    points.push_back(
        {{static_cast<float>(p.x()), static_cast<float>(p.y()), static_cast<float>(p.z())},
         std::round(255 * mesh.surface_reflectivity[hit.surface] * cos_incidence),
         static_cast<float>(lots.uniform())});
  }
  return points;
}

}  // namespace

PointCloud survey(const SurveyModel& model, const SceneMesh& mesh, const Raycaster& raycaster,
                  const std::vector<Vec3>& stations, std::uint64_t seed) {
  std::vector<double> surface_bias;
  RandomStream bias_random(seed, RandomPurpose::kSurfaceBias, 0);
  for (std::size_t i = 0; i < mesh.surfaces(); ++i) {
    surface_bias.push_back(model.surface_bias_m * bias_random.normal());
  }
  const auto columns = static_cast<std::size_t>(360 / model.angular_step_deg);
  PointCloud cloud;
  Voxels voxels(model.spacing_m);
  std::vector<std::vector<MapPoint>> sweeps(columns);
  for (std::size_t station = 0; station < stations.size(); ++station) {
    tbb::parallel_for(std::size_t{0}, columns, [&](std::size_t column) {
      const double azimuth =
          2 * std::numbers::pi * static_cast<double>(column) / static_cast<double>(columns);
      sweeps[column] =
          sweep(model, mesh, raycaster, surface_bias, stations[station], azimuth,
                RandomStream(seed, RandomPurpose::kSurvey, station * columns + column),
                RandomStream(seed, RandomPurpose::kSurveyLots, station * columns + column));
    });
    for (const std::vector<MapPoint>& points : sweeps) {
      for (const MapPoint& point : points) keep(point, voxels, cloud);
    }
  }
  return cloud;
}

}  // namespace paloc::synth

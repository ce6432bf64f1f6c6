#include "paloc/tools/bench_place.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "paloc/tools/synth_random.h"
#include "paloc/tools/synth_recording.h"

namespace paloc {
namespace {

using synth::RandomPurpose;
using synth::RandomStream;

constexpr double kDegree = std::numbers::pi / 180;
constexpr double kAsideM = 0.3, kUpM = 0.2, kTiltSigmaRad = 4 * kDegree, kCarryHeightM = 1.35;

/// A point of the closed route, evenly spread over its length.
Vec3 somewhereOn(const std::vector<Vec3>& route, RandomStream& random) {
  double length = 0;
  const auto leg = [&](std::size_t i) -> Vec3 { return route[(i + 1) % route.size()] - route[i]; };
  for (std::size_t i = 0; i < route.size(); ++i) length += leg(i).norm();
  double left = random.uniform() * length;
  std::size_t i = 0;
  while (i + 1 < route.size() && left > leg(i).norm()) left -= leg(i++).norm();
  return route[i] + left * leg(i).normalized();
}

}  // namespace

BenchPlace::BenchPlace(synth::Scene scene, const synth::SurveyModel& survey_model,
                       const MapSettings& settings, std::uint64_t seed)
    : scene_(std::move(scene)),
      raycaster_(scene_.mesh),
      seed_(seed),
      settings_(settings),
      survey_(survey(survey_model, scene_.mesh, raycaster_, scene_.survey_stations, seed)),
      map_(PriorMap::build(survey_, settings, scene_.name)) {}

std::shared_ptr<const PriorMap> BenchPlace::mapBefore(const Vec3& normal, double height_m) const {
  PointCloud part;
  for (const Point3f& p : survey_.points) {
    const Vec3 at(static_cast<double>(p.x), static_cast<double>(p.y), static_cast<double>(p.z));
    if (normal.dot(at) < height_m) part.points.push_back(p);
  }
  return PriorMap::build(part, settings_, scene_.name + ", a part");
}

Pose BenchPlace::pose(std::size_t index) const {
  RandomStream random(seed_, RandomPurpose::kPose, index);
  Vec3 at = somewhereOn(scene_.route, random);
  for (int axis = 0; axis < 2; ++axis) at[axis] += kAsideM * (2 * random.uniform() - 1);
  at.z() += kCarryHeightM + kUpM * (2 * random.uniform() - 1);
  const double yaw = 2 * std::numbers::pi * random.uniform();
  const double roll = kTiltSigmaRad * random.normal(), pitch = kTiltSigmaRad * random.normal();
  return {at, so3::exp(Vec3(0, 0, yaw)) * so3::exp(Vec3(roll, pitch, 0))};
}

Scan BenchPlace::scanAt(const synth::SensorModel& sensor, const Pose& T_map_body,
                        std::size_t index) const {
  const Pose T_body_lidar = synth::defaultExtrinsic();
  const synth::Motion still({T_map_body}, 0.05, 0);
  const synth::Surroundings surroundings(raycaster_);
  const synth::LidarSimulator simulator(sensor, T_body_lidar, scene_.mesh, surroundings, still,
                                        seed_);
  const auto observation = simulator.scan(index, 0);
  Scan scan;
  scan.sensor_position_body = T_body_lidar.position;
  for (std::size_t i = 0; i < observation->size(); ++i) {
    const Vec3 p = T_body_lidar * Vec3(observation->x[i], observation->y[i], observation->z[i]);
    scan.points_body.push_back(
        {static_cast<float>(p.x()), static_cast<float>(p.y()), static_cast<float>(p.z())});
  }
  return scan;
}

synth::Scene mirrored(synth::Scene scene) {
  scene.name += "-mirrored";
  for (Point3f& vertex : scene.mesh.vertices) vertex.y = -vertex.y;
  for (auto& triangle : scene.mesh.triangles) std::swap(triangle[0], triangle[1]);
  for (Vec3& corner : scene.route) corner.y() = -corner.y();
  for (Vec3& station : scene.survey_stations) station.y() = -station.y();
  return scene;
}

}  // namespace paloc

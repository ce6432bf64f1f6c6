#include "paloc/tools/synth_added_boxes.h"

#include <array>
#include <cmath>
#include <numbers>
#include <optional>

namespace paloc::synth {
namespace {

constexpr double kLength = 0.5, kDepth = 0.4, kHeight = 0.9;
constexpr double kBeside = 1.0;  // m from the way to the box's middle
constexpr double kFree = 0.45;   // m about its middle, half its diagonal and more
constexpr double kClear = 0.75;  // m from the way to its middle, at least
constexpr double kSampleInterval_s = 0.25;
constexpr float kCardboard = 0.5F;

double distance(const Raycaster& scene, const Vec3& from, const Vec3& direction) {
  const Eigen::Vector3f d = direction.cast<float>();
  RayHit hit;
  scene.cast(from, {&d, 1}, {&hit, 1});
  return static_cast<double>(hit.distance_m);
}

// Nothing between the way and the place, and nothing about it at three heights.
bool isFree(const Raycaster& scene, const Vec3& way, const Vec3& place, double floor_z) {
  for (const double z : {0.1, 0.5, kHeight}) {
    const Vec3 from(way.x(), way.y(), floor_z + z), to(place.x(), place.y(), floor_z + z);
    if (distance(scene, from, (to - from).normalized()) < (to - from).norm() + kFree) return false;
    for (int i = 0; i < 24; ++i) {
      const double angle = i * std::numbers::pi / 12;
      if (distance(scene, to, Vec3(std::cos(angle), std::sin(angle), 0)) < kFree) return false;
    }
  }
  const double above = distance(scene, Vec3(place.x(), place.y(), floor_z + 0.05), Vec3::UnitZ());
  return above > kHeight + 0.1;
}

std::vector<Vec3> samplesOf(const Motion& motion) {
  std::vector<Vec3> way;
  for (double t = 0; t < motion.duration(); t += kSampleInterval_s) {
    way.push_back(motion.at(motion.startNs() + nsFromSeconds(t)).T_map_body.position);
  }
  return way;
}

std::optional<OrientedBox> boxBeside(const std::vector<Vec3>& way, std::size_t i,
                                     const Raycaster& scene) {
  const Vec3 ahead = way[i + 1] - way[i];
  if (ahead.head<2>().norm() < 0.1) return std::nullopt;
  const double yaw = std::atan2(ahead.y(), ahead.x());
  const double down = distance(scene, way[i], -Vec3::UnitZ());
  if (!(down < 3)) return std::nullopt;
  for (const double side : {1.0, -1.0}) {
    const Vec3 left(-std::sin(yaw), std::cos(yaw), 0);
    Vec3 place = way[i] + side * kBeside * left;
    place.z() = way[i].z() - down;
    bool clear = true;
    for (const Vec3& p : way) clear = clear && (p - place).head<2>().norm() > kClear;
    if (!clear || !isFree(scene, way[i], place, place.z())) continue;
    return OrientedBox{{place, so3::exp(Vec3(0, 0, yaw))},
                       Vec3(-kLength / 2, -kDepth / 2, 0),
                       Vec3(kLength / 2, kDepth / 2, kHeight)};
  }
  return std::nullopt;
}

}  // namespace

std::vector<OrientedBox> placesForBoxes(std::size_t wanted, const Motion& motion,
                                        const Raycaster& scene) {
  const std::vector<Vec3> way = samplesOf(motion);
  std::vector<OrientedBox> boxes;
  for (std::size_t k = 0; k < wanted; ++k) {
    // The first free place in each of as many pieces of the way as there are boxes.
    const std::size_t end = (k + 1) * (way.size() - 1) / wanted;
    for (std::size_t i = k * (way.size() - 1) / wanted; i < end; ++i) {
      std::optional<OrientedBox> box = boxBeside(way, i, scene);
      const auto apart = [&](const OrientedBox& other) {
        return (other.T_scene_box.position - box->T_scene_box.position).norm() > 2 * kFree;
      };
      if (!box || !std::all_of(boxes.begin(), boxes.end(), apart)) continue;
      boxes.push_back(*box);
      break;
    }
  }
  return boxes;
}

void addBox(SceneMesh& mesh, const OrientedBox& box) {
  MeshBuilder builder;
  builder.box(box.T_scene_box, box.low, box.high, kCardboard);
  const SceneMesh piece = builder.take();
  const auto vertices = static_cast<std::uint32_t>(mesh.vertices.size());
  const auto surfaces = static_cast<std::uint32_t>(mesh.surfaces());
  mesh.vertices.insert(mesh.vertices.end(), piece.vertices.begin(), piece.vertices.end());
  for (const auto& [a, b, c] : piece.triangles) {
    mesh.triangles.push_back({a + vertices, b + vertices, c + vertices});
  }
  for (const std::uint32_t s : piece.triangle_surface)
    mesh.triangle_surface.push_back(s + surfaces);
  mesh.surface_reflectivity.insert(mesh.surface_reflectivity.end(),
                                   piece.surface_reflectivity.begin(),
                                   piece.surface_reflectivity.end());
}

}  // namespace paloc::synth

#include "paloc/tools/synth_surroundings.h"

#include <cmath>

namespace paloc::synth {
namespace {

constexpr double kMirrored = 0.3;        // share of the rays; real panes: 0.1 to 1 by incidence
constexpr double kReturned = 0.5;        // of the rays that meet the pane squarely
constexpr double kSquareCosine = 0.966;  // 15 degrees

}  // namespace

RayHit Surroundings::castOne(TimeNs t_ns, const Vec3& origin,
                             const Eigen::Vector3f& direction) const {
  RayHit hit;
  raycaster.cast(origin, {&direction, 1}, {&hit, 1});
  people.intersect(t_ns, origin, {&direction, 1}, people_surface, {&hit, 1});
  return hit;
}

void Surroundings::throughPane(const GlassPane& pane, TimeNs t_ns, const Vec3& origin,
                               const Eigen::Vector3f& direction, RandomStream& random,
                               RayHit& hit) const {
  const Vec3 normal = pane.T_scene_pane.rotation.col(1);
  const Vec3 d = direction.cast<double>();
  const double cosine = d.dot(normal);
  if (std::abs(cosine) < 1e-6) return;
  const double along = (pane.T_scene_pane.position - origin).dot(normal) / cosine;
  if (along <= 0 || along >= static_cast<double>(hit.distance_m)) return;
  const Vec3 at = origin + along * d;
  const Vec3 in_pane = pane.T_scene_pane.inverse() * at;
  if (in_pane.x() < 0 || in_pane.x() > pane.width_m || in_pane.z() < 0 ||
      in_pane.z() > pane.height_m) {
    return;
  }
  const double fate = random.uniform();
  if (fate < kMirrored) {
    const Vec3 mirrored = d - 2 * cosine * normal;
    hit = castOne(t_ns, at, mirrored.normalized().cast<float>());
    if (!hit.valid()) return;
    hit.distance_m += static_cast<float>(along);
    // As the ray would see it behind the pane.
    const Eigen::Vector3f n = normal.cast<float>();
    hit.normal_scene -= 2 * hit.normal_scene.dot(n) * n;
  } else if (fate < kMirrored + kReturned && std::abs(cosine) > kSquareCosine) {
    hit.distance_m = static_cast<float>(along);
    hit.surface = glass_surface;
    hit.normal_scene = (cosine > 0 ? Vec3(-normal) : normal).cast<float>();
  }
}

void Surroundings::cast(TimeNs t_ns, const Vec3& origin,
                        std::span<const Eigen::Vector3f> directions, RandomStream& random,
                        std::span<RayHit> hits) const {
  raycaster.cast(origin, directions, hits);
  people.intersect(t_ns, origin, directions, people_surface, hits);
  for (std::size_t i = 0; i < directions.size(); ++i) {
    for (const GlassPane& pane : panes)
      throughPane(pane, t_ns, origin, directions[i], random, hits[i]);
  }
}

}  // namespace paloc::synth

#pragma once

#include "paloc/tools/synth_changeables.h"
#include "paloc/tools/synth_people.h"
#include "paloc/tools/synth_random.h"

namespace paloc::synth {

/// What the LiDAR has about it: a mesh that stands still, people who walk, panes of glass.
struct Surroundings {
  explicit Surroundings(const Raycaster& mesh) : raycaster(mesh) {}

  const Raycaster& raycaster;
  WalkingPeople people;
  std::uint32_t people_surface = 0;  ///< their surface in the mesh
  std::vector<GlassPane> panes;
  std::uint32_t glass_surface = 0;

  /// Casts rays as Raycaster does, at a time. A pane mirrors some of the rays: the hit is what the
  /// mirrored ray meets, at the length of the whole way; some come back from a pane hit squarely,
  /// all others go through it. Draws random numbers for panes only.
  void cast(TimeNs t_ns, const Vec3& origin_scene,
            std::span<const Eigen::Vector3f> directions_scene, RandomStream& random,
            std::span<RayHit> hits) const;

 private:
  RayHit castOne(TimeNs t_ns, const Vec3& origin_scene, const Eigen::Vector3f& direction) const;
  void throughPane(const GlassPane& pane, TimeNs t_ns, const Vec3& origin_scene,
                   const Eigen::Vector3f& direction, RandomStream& random, RayHit& hit) const;
};

}  // namespace paloc::synth

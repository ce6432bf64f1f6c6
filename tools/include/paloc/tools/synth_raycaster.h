#pragma once

#include <limits>
#include <memory>
#include <span>

#include "paloc/tools/synth_mesh.h"

namespace paloc::synth {

/// What a ray met.
struct RayHit {
  float distance_m = std::numeric_limits<float>::infinity();  ///< infinite: nothing
  std::uint32_t surface = 0;                                  ///< of the mesh
  Eigen::Vector3f normal_scene = Eigen::Vector3f::Zero();     ///< unit, towards the ray's origin

  bool valid() const { return distance_m < std::numeric_limits<float>::infinity(); }
};

/// Rays through a mesh, by Embree. Any number of threads may cast at the same time.
class Raycaster {
 public:
  explicit Raycaster(const SceneMesh& mesh);
  ~Raycaster();
  Raycaster(const Raycaster&) = delete;
  Raycaster& operator=(const Raycaster&) = delete;

  /// Casts rays from one origin (scene frame, m) along unit vectors; one hit for each.
  void cast(const Vec3& origin_scene, std::span<const Eigen::Vector3f> directions_scene,
            std::span<RayHit> hits) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace paloc::synth

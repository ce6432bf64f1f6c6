#pragma once

#include <limits>
#include <span>
#include <vector>

#include "paloc/tools/synth_motion.h"
#include "paloc/tools/synth_raycaster.h"

namespace paloc::synth {

/// A person: an upright cylinder with a ball on top.
struct PersonShape {
  double radius_m = 0.22, shoulder_m = 1.48;
  double head_radius_m = 0.12, head_m = 1.62;  ///< the ball's middle above the floor
};

/// People who walk about: the first ahead of the recording body, the second behind it, all others
/// to and fro over a piece of its way, half a metre beside it.
class WalkingPeople {
 public:
  /// Where a person stands, every kStep_s from the motion's start (scene frame, m, on the floor).
  using Track = std::vector<Vec3>;
  static constexpr double kStep_s = 0.05;

  WalkingPeople() = default;
  /// `scene` tells the floor below the way.
  WalkingPeople(std::size_t count, const Motion& motion, const Raycaster& scene);

  bool empty() const { return tracks_.empty(); }
  const std::vector<Track>& tracks() const { return tracks_; }
  const PersonShape& shape() const { return shape_; }
  TimeNs startNs() const { return start_ns_; }

  /// Puts people in the way of rays cast at `t_ns`: hits that lie behind one become hits of it,
  /// with the surface given.
  void intersect(TimeNs t_ns, const Vec3& origin_scene,
                 std::span<const Eigen::Vector3f> directions_scene, std::uint32_t surface,
                 std::span<RayHit> hits) const;

 private:
  Vec3 at(const Track& track, TimeNs t_ns) const;

  PersonShape shape_;
  TimeNs start_ns_ = 0;
  std::vector<Track> tracks_;
};

}  // namespace paloc::synth

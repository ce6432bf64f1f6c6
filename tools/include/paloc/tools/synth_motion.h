#pragma once

#include <array>
#include <vector>

#include "paloc/core/pose.h"
#include "paloc/core/time.h"

namespace paloc::synth {

/// Position, rotation and their derivatives of the body at one instant.
struct MotionState {
  Pose T_map_body;
  Vec3 v_map = Vec3::Zero();       ///< m/s
  Vec3 a_map = Vec3::Zero();       ///< m/s2, without gravity
  Vec3 omega_body = Vec3::Zero();  ///< rad/s
};

/// The motion of the body: a uniform B-spline of degree five (four times continuously
/// differentiable) through seven dimensions, the position and the four components of an unscaled
/// quaternion q. The rotation is q / |q|; its rate, exactly, omega_body = 2 Im(conj(q) dq/dt) /
/// |q|^2. The poses given are the spline's control points: it follows them, smoothed, and where six
/// are equal it stands perfectly still.
class Motion {
 public:
  /// Poses T_map_body at the times start, start + dt, ...; at least one. The first and the last are
  /// held beyond the ends.
  Motion(const std::vector<Pose>& poses, double dt_s, TimeNs start_ns);

  TimeNs startNs() const { return start_ns_; }
  double duration() const { return duration_s_; }  ///< from the first pose to the last (s)
  MotionState at(TimeNs t_ns) const;

 private:
  using Control = std::array<double, 7>;
  double dt_s_, duration_s_;
  TimeNs start_ns_;
  std::vector<Control> controls_;
};

}  // namespace paloc::synth

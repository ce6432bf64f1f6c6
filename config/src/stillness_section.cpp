#include "section.h"

namespace paloc {

std::vector<Setting> stillnessSettings() {
  using S = StillnessSettings;
  Section s(
      "stillness", [](auto& config) -> auto& { return config.estimator.stillness; });
  s.flag("enabled", &S::enabled, "Use zero velocity, no motion and gravity while standing still.");
  s.number("window_s", &S::window_s, "s", {0.1, 60}, "Rest is judged over this long.");
  s.number("max_rate_deviation_radps", &S::max_rate_deviation_radps, "rad/s", {0, 10},
           "Standard deviation of the angular rate, above: no rest.");
  s.number("max_force_deviation_mps2", &S::max_force_deviation_mps2, "m/s2", {0, 100},
           "Standard deviation of the specific force, above: no rest.");
  s.number("max_mean_rate_radps", &S::max_mean_rate_radps, "rad/s", {0, 10},
           "Mean angular rate less its bias, above: no rest.");
  s.number("max_odometry_speed_mps", &S::max_odometry_speed_mps, "m/s", {0, 100},
           "Speed of the odometry over the window, above: no rest.");
  s.number("max_odometry_rate_radps", &S::max_odometry_rate_radps, "rad/s", {0, 10},
           "Turning rate of the odometry over the window, above: no rest.");
  s.number("leave_ratio", &S::leave_ratio, "", {1, 10},
           "A rest ends where a limit is exceeded by this factor.");
  s.number("zero_velocity_sigma_mps", &S::zero_velocity_sigma_mps, "m/s", {1e-6, 10},
           "Standard deviation of the velocity at rest.");
  s.number("no_motion_sigma_position_m", &S::no_motion_sigma_position_m, "m", {1e-6, 10},
           "Standard deviation of the motion between two nodes at rest.");
  s.number("no_motion_sigma_rotation_rad", &S::no_motion_sigma_rotation_rad, "rad", {1e-7, 1},
           "Likewise of the rotation.");
  s.number("gravity_sigma_direction_rad", &S::gravity_sigma_direction_rad, "rad", {1e-6, 1},
           "Standard deviation of the direction of the mean force at rest.");
  s.number("gravity_sigma_magnitude", &S::gravity_sigma_magnitude, "", {1e-9, 1},
           "Standard deviation of the length of the gravity direction about one.");
  return std::move(s).rows();
}

}  // namespace paloc

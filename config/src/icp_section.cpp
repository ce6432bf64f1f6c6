#include "section.h"

namespace paloc {

std::vector<Setting> icpSettings() {
  using S = IcpSettings;
  Section s(
      "icp", [](auto& config) -> auto& { return config.frontend.icp; });
  s.count("map_points", &S::map_points, {100, 1e6},
          "Front-end icp: points of a scan that are put into the local map.");
  s.count("max_iterations", &S::max_iterations, {1, 1000},
          "Steps of an update; a scan that needs more is not registered.");
  s.number("sigma_velocity_mps", &S::sigma_velocity_mps, "m/s", {1e-3, 100},
           "Standard deviation of the velocity at the start, each axis.");
  s.number("sigma_rate_radps", &S::sigma_rate_radps, "rad/s", {1e-3, 10},
           "Standard deviation of the angular velocity at the start, each axis.");
  s.number("sigma_acceleration_mps2", &S::sigma_acceleration_mps2, "m/s2", {1e-3, 1000},
           "How uneven the motion is: change of the mean velocity from scan to scan, a second.");
  s.number("sigma_angular_acceleration_radps2", &S::sigma_angular_acceleration_radps2, "rad/s2",
           {1e-3, 1000}, "Likewise, of the rotation.");
  return std::move(s).rows();
}

}  // namespace paloc

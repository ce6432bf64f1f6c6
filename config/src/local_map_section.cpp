#include "section.h"

namespace paloc {

std::vector<Setting> localMapSettings() {
  using S = LocalMapSettings;
  Section s(
      "local_map", [](auto& config) -> auto& { return config.frontend.local_map; });
  s.number("voxel_m", &S::voxel_m, "m", {0.05, 10},
           "Front-ends fast_lio and icp: edge of the local map's smallest voxels.");
  s.number("level_factor", &S::level_factor, "", {1.1, 10},
           "From one size of voxels to the next; the larger serve where points are few.");
  s.count("levels", &S::levels, {1, 8}, "Sizes of voxels.");
  s.count("max_voxels", &S::max_voxels, {1000, 1e8},
          "Voxels of each size that the local map keeps; the oldest are forgotten.");
  s.number("max_distance_m", &S::max_distance_m, "m", {1, 10000},
           "Voxels further away are the first to be forgotten.");
  s.count("registration_points", &S::registration_points, {100, 1e6},
          "Points of a scan that are registered, spread evenly over the surfaces.");
  s.number("noise_floor_m", &S::noise_floor_m, "m", {1e-4, 1},
           "Least standard deviation of a point about its plane.");
  s.number("max_gate_m", &S::max_gate_m, "m", {0.01, 100},
           "Points further from their plane are never used.");
  s.number("max_gap_s", &S::max_gap_s, "s", {0.01, 60},
           "After a longer pause of the scans the odometry begins anew.");
  return std::move(s).rows();
}

}  // namespace paloc

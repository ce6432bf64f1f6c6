#include "section.h"

namespace paloc {

std::vector<Setting> matcherSettings() {
  using S = MatcherSettings;
  Section s(
      "matcher", [](auto& config) -> auto& { return config.matcher; });
  s.number("scan_voxel_m", &S::scan_voxel_m, "m", {0.01, 10},
           "Edge of the voxels that a scan is thinned with.");
  s.count("max_points", &S::max_points, {100, 1000000}, "Points of a scan kept after thinning.");
  s.number("max_distance_m", &S::max_distance_m, "m", {0.01, 10},
           "Largest distance between a scan's point and its map point when tracking.");
  s.number("range_noise_m", &S::range_noise_m, "m", {1e-4, 1},
           "Standard deviation of a return's range, from the data sheet.");
  s.number("map_noise_m", &S::map_noise_m, "m", {1e-4, 1},
           "Standard deviation of a map point about its surface.");
  s.number("plane_bias_m", &S::plane_bias_m, "m", {0, 1},
           "Error that all returns from one plane patch share.");
  s.number("range_bias_m", &S::range_bias_m, "m", {0, 1},
           "Error that all returns of a scan share.");
  s.number("min_overlap", &S::min_overlap, "", {0, 1},
           "Share of a scan's points that must find a plane of the map.");
  s.count("min_inliers", &S::min_inliers, {6, 1000000},
          "Fewer points within the gate and the match is refused.");
  s.number("max_residual_rms_m", &S::max_residual_rms_m, "m", {1e-3, 10},
           "Larger residuals of the inliers and the match is refused.");
  s.count("max_iterations", &S::max_iterations, {1, 1000}, "Steps of the registration.");
  s.count("threads", &S::threads, {1, 64},
          "Threads that seek correspondences; no influence on the result.");
  return std::move(s).rows();
}

}  // namespace paloc

#pragma once

namespace paloc {

/// Settings of the registration of a scan to the prior map.
struct MatcherSettings {
  double scan_voxel_m = 0.25;      ///< edge of the voxels that the scan is thinned with
  int max_points = 4000;           ///< after thinning
  double max_distance_m = 0.5;     ///< point to map point, for a correspondence, when tracking
  double range_noise_m = 0.02;     ///< standard deviation of a return's range, from the data sheet
  double map_noise_m = 0.005;      ///< of a map point about its surface
  double plane_bias_m = 0.005;     ///< error that all returns from one plane patch share
  double range_bias_m = 0.003;     ///< error that all returns of a scan share
  double min_overlap = 0.4;        ///< share of points that must find a plane
  int min_inliers = 100;
  double max_residual_rms_m = 0.12;
  int max_iterations = 20;
  int threads = 2;
};

}  // namespace paloc

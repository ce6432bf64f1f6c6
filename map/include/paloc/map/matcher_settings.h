#pragma once

namespace paloc {

/// Settings of the registration of a scan to the prior map.
struct MatcherSettings {
  int max_points = 2500;  ///< of a scan, each the mean of the returns about it
  double max_distance_m =
      0.5;  ///< point to map point, in the first two iterations of a tracking match
  double fine_distance_m = 0.2;       ///< the same, from the third iteration on
  double research_distance_m = 0.02;  ///< a point that moved less keeps its correspondence
  double range_noise_m = 0.02;     ///< standard deviation of a return's range, from the data sheet
  double map_noise_m = 0.005;      ///< of a map point about its surface
  double normal_noise_rad = 0.01;  ///< of a map normal beyond what its fit tells: uneven walls
  double plane_bias_m = 0.005;     ///< error that all returns from one plane patch share
  double plane_patch_m = 5;        ///< radius of such a patch: a wall, as far as it shares an error
  double range_bias_m = 0.003;     ///< error that all returns of a scan share
  double min_overlap = 0.2;        ///< share of points that must find a plane
  int min_inliers = 100;
  double max_residual_rms_m = 0.12;
  double max_step_sigmas = 4;      ///< step from the prediction, in its standard deviations
  double step_floor_m = 0.1;       ///< added to the prediction's sigma of position (in squares)
  double step_floor_rad = 0.02;    ///< the same for rotation
  int max_iterations = 40;         // most scans need fewer than ten; thick maps now and then more
  double locate_distance_m = 1.5;  ///< point to map point, in the first iterations of a rough start
  double locate_max_step_m = 1.5;  ///< furthest that a rough start is corrected by
  double locate_max_step_rad = 0.35;
  double locate_min_inlier_share = 0.8;  ///< of the matched points, within 10 cm of their plane
  double start_reach_m = 3.0;            ///< a start is searched within this of a rough position
  double start_reach_rad = 0.8;          ///< and within this of a rough pose's heading
  double start_position_reach_m = 1.0;   ///< the same where only a position is known
  double start_cell_m = 0.2;  ///< grid of the search; coarser where the map is too large for it
  double start_min_explained = 0.4;  ///< share of points on the map's surfaces
  /// Share of points where the map has open space, with what chance may add to it: half of what is
  /// seen may be missing in the map of the right place, but little may contradict it.
  double start_max_contradicted = 0.03;
  double start_min_lead = 0.06;      ///< of the best place before the second-best
  double start_max_mlookups = 4000;  ///< effort before a search is given up, in million look-ups
  bool degeneracy_handling = true;  ///< weak directions are scaled down, open ones held and cut off
  bool spectrum = true;             ///< compute MapMatch::spectrum
  int threads = 2;
};

}  // namespace paloc

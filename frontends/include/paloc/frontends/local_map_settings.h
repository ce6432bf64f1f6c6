#pragma once

namespace paloc {

/// Settings of the local map of the front-ends `fast_lio` and `icp`, and of how scans are
/// registered to it.
struct LocalMapSettings {
  double voxel_m = 0.2;            ///< edge of the smallest voxels
  double level_factor = 2.5;       ///< from one size of voxels to the next
  int levels = 3;                  ///< sizes of voxels
  int max_voxels = 150'000;        ///< of each size, before the oldest are forgotten
  double max_distance_m = 100;     ///< voxels further away are the first to be forgotten
  int registration_points = 3000;  ///< of a scan, spread evenly over the surfaces
  double noise_floor_m = 0.005;    ///< least standard deviation of a point about its plane
  double max_gate_m = 0.5;         ///< residuals beyond are never used
  double max_gap_s = 2;            ///< without a scan: longer, and the odometry begins anew
};

}  // namespace paloc

#include "section.h"

namespace paloc {
namespace {

using S = LioSamSettings;

template <typename AnySection>
void addFeatures(AnySection& s) {
  s.number(
      "feature_window_m", &S::feature_window_m, "m", {0.01, 10},
      "Front-end lio_sam: way along a ring, to each side of a point, whose bend is looked at.");
  s.number(
      "edge_bend", &S::edge_bend, "", {0, 2},
      "Bend from which on a point may be an edge: 0 on a straight line, 0.7 at a right angle.");
  s.number("plane_bend", &S::plane_bend, "", {0, 2},
           "Bend up to which a point may lie on a plane.");
  s.number("range_noise_m", &S::range_noise_m, "m", {1e-4, 1},
           "Standard deviation of the LiDAR's ranges: bends that it makes are none.");
  s.count("edges_per_sector", &S::edges_per_sector, {0, 1000},
          "Edge points of each sixth of a ring, at most; 0 registers planes only.");
  s.count("registration_planes", &S::registration_planes, {100, 1e6},
          "Plane points of a scan that are registered, spread evenly over the surfaces.");
  s.count("registration_edges", &S::registration_edges, {1, 1e6},
          "Edge points of a scan that are registered, about, at most.");
}

template <typename AnySection>
void addKeyFrames(AnySection& s) {
  s.number("key_frame_distance_m", &S::key_frame_distance_m, "m", {0.01, 100},
           "A scan further than this from the last key frame becomes one.");
  s.number("key_frame_turn_rad", &S::key_frame_turn_rad, "rad", {0.01, 3.2},
           "A scan turned by more than this since the last key frame becomes one.");
  s.number("key_frame_matched", &S::key_frame_matched, "", {0, 1},
           "A scan of which a smaller share lies on the local map becomes a key frame.");
  s.count("max_key_frames", &S::max_key_frames, {2, 1e6},
          "Key frames of the local map; beyond, those far away and then the oldest are forgotten.");
  s.number("max_distance_m", &S::max_distance_m, "m", {1, 10000},
           "Key frames further away are the first to be forgotten.");
  s.count("map_planes", &S::map_planes, {100, 1e6},
          "Plane points of a key frame, spread evenly over the surfaces.");
  s.number("voxel_m", &S::voxel_m, "m", {0.05, 10},
           "Edge of the local map's smallest voxels of planes.");
  s.number("level_factor", &S::level_factor, "", {1.1, 10},
           "From one size of voxels to the next; the larger serve where points are few.");
  s.count("levels", &S::levels, {1, 8}, "Sizes of voxels.");
  s.number("line_voxel_m", &S::line_voxel_m, "m", {0.05, 10},
           "Edge of the local map's voxels of lines.");
}

template <typename AnySection>
void addEstimation(AnySection& s) {
  s.count("max_iterations", &S::max_iterations, {1, 1000}, "Steps of a registration.");
  s.number("noise_floor_m", &S::noise_floor_m, "m", {1e-4, 1},
           "Least standard deviation of a point about its plane or line.");
  s.number("max_gate_m", &S::max_gate_m, "m", {0.01, 100},
           "Points further from their plane or line are never used.");
  s.number("max_gap_s", &S::max_gap_s, "s", {0.01, 60},
           "After a longer pause of the scans the odometry begins anew.");
  s.number("lag_s", &S::lag_s, "s", {0.1, 60}, "Length of the smoother's window.");
  s.number("sigma_velocity_mps", &S::sigma_velocity_mps, "m/s", {1e-3, 100},
           "Standard deviation of the first velocity, each axis, where the IMU is not at rest.");
  s.number("sigma_bias_acc_mps2", &S::sigma_bias_acc_mps2, "m/s2", {1e-6, 10},
           "Standard deviation of the accelerometer's bias at the start.");
  s.number("sigma_bias_gyro_radps", &S::sigma_bias_gyro_radps, "rad/s", {1e-8, 1},
           "Standard deviation of the gyroscope's bias at the start.");
  s.number("sigma_acceleration_mps2", &S::sigma_acceleration_mps2, "m/s2", {1e-3, 100},
           "Standard deviation of the body's mean acceleration during the first scan, where the "
           "IMU is not at rest.");
}

}  // namespace

std::vector<Setting> lioSamSettings() {
  Section s(
      "lio_sam", [](auto& config) -> auto& { return config.frontend.lio_sam; });
  addFeatures(s);
  addKeyFrames(s);
  addEstimation(s);
  return std::move(s).rows();
}

}  // namespace paloc

#include "section.h"

namespace paloc {

std::vector<Setting> frontendSettings() {
  using S = FrontendSettings;
  Section s(
      "frontend", [](auto& config) -> auto& { return config.frontend; });
  s.text("lidar_label", &S::lidar_label,
         "Sensor label of the scans; empty takes the only LiDAR there is.");
  s.text("imu_label", &S::imu_label, "Sensor label of the IMU; empty takes the only one there is.");
  s.text("odometry_label", &S::odometry_label,
         "Sensor label of the recorded odometry; empty takes the only one there is.");
  s.text("odometry_file", &S::odometry_file,
         "A TUM file that replaces the recording's odometry; empty for none.");
  s.number("min_range_m", &S::min_range_m, "m", {0, 100},
           "Nearer returns are taken for the platform itself and left out.");
  s.number("max_range_m", &S::max_range_m, "m", {0.1, 10000}, "Farther returns are left out.");
  s.flag("deskew", &S::deskew, "Undo the motion during a scan where its points have times.");
  s.number("odometry_sigma_position_floor_m", &S::odometry_sigma_position_floor_m, "m", {1e-6, 10},
           "Least standard deviation of the motion between scans, where the odometry gives none.");
  s.number("odometry_sigma_position_ratio", &S::odometry_sigma_position_ratio, "", {0, 1},
           "Standard deviation of that motion per metre of way since the last scan.");
  s.number("odometry_sigma_rotation_floor_rad", &S::odometry_sigma_rotation_floor_rad, "rad",
           {1e-6, 1}, "Least standard deviation of the rotation between two scans.");
  s.number("odometry_sigma_rotation_ratio", &S::odometry_sigma_rotation_ratio, "", {0, 1},
           "Standard deviation of that rotation per radian turned since the last scan.");
  s.number("max_odometry_gap_s", &S::max_odometry_gap_s, "s", {1e-3, 60},
           "Odometry poses further apart than this are not interpolated.");
  s.number("max_odometry_extrapolation_s", &S::max_odometry_extrapolation_s, "s", {0, 1},
           "Beyond its last pose the odometry is carried on at even speed for so long.");
  s.number("max_odometry_speed_mps", &S::max_odometry_speed_mps, "m/s", {0.1, 1000},
           "A faster step of the odometry is taken for a jump, not for a motion.");
  s.number("max_odometry_rate_radps", &S::max_odometry_rate_radps, "rad/s", {0.1, 1000},
           "A faster turn of the odometry is taken for a jump, not for a motion.");
  s.number("max_imu_gap_s", &S::max_imu_gap_s, "s", {1e-3, 10},
           "IMU samples further apart than this are not integrated over.");
  s.number("max_wait_s", &S::max_wait_s, "s", {0, 60},
           "Recorded time for which a scan waits for the IMU and the odometry to reach its end.");
  return std::move(s).rows();
}

}  // namespace paloc

#pragma once

namespace paloc {

/// Settings of the front-end `icp`, besides those of its local map.
struct IcpSettings {
  /// Of a scan that go into the local map, spread evenly over the surfaces. More than for
  /// `fast_lio`: without an IMU the scan alone tells of a turn into a room that was just seen.
  int map_points = 20000;
  int max_iterations = 20;  ///< a scan that needs more is not registered

  // Standard deviations of each axis.
  double sigma_velocity_mps = 1.5;  ///< of the first scan
  double sigma_rate_radps = 1;      ///< likewise, of the rotation
  /// How much the mean velocity changes from scan to scan, a second.
  double sigma_acceleration_mps2 = 2;
  double sigma_angular_acceleration_radps2 = 4;  ///< likewise, of the rotation
};

}  // namespace paloc

#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "paloc/core/pose.h"
#include "paloc/core/time.h"

namespace paloc {

/// A LiDAR scan as the sensor gave it, decoded from whatever observation class it came in: valid
/// returns only, in the sensor's own frame.
struct LidarFrame {
  TimeNs stamp_ns = 0;  ///< of the first point
  TimeNs duration_ns =
      0;  ///< from the first to the last firing; 0 where the scan is already deskewed
  bool deskewed = false;   ///< points are already as seen from one instant, stamp + duration
  std::string class_name;  ///< of the observation that it came in
  std::string label;
  std::string time_policy;  ///< how the times of its points were read, as a clause for the user
  Pose T_body_lidar;
  std::vector<Point3f> points_lidar;  ///< finite, m
  std::vector<std::uint32_t> dt_ns;   ///< after the stamp; empty if unknown or deskewed
  std::vector<float> intensity;       ///< empty, or one per point
  std::vector<std::uint16_t> ring;    ///< empty, or one per point
  std::size_t invalid_points = 0;     ///< non-finite or zero returns that were left out

  TimeNs endNs() const { return stamp_ns + duration_ns; }
};

}  // namespace paloc

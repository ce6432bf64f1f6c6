#pragma once

#include <vector>

#include "paloc/core/odometry_frame.h"
#include "paloc/core/pose.h"
#include "paloc/core/trajectory.h"
#include "paloc/map/point_cloud.h"

namespace paloc {

/// Gathers thinned scans during a replay, and puts them into the map's frame once the trajectory is
/// known. Scans taken while the platform hardly moved are left out: they bring nothing new.
class ScanMap {
 public:
  void add(const OdometryFrame& frame);
  /// All points in the map's frame, one a voxel of `voxel_m` (m). Scans without a usable pose stay
  /// out.
  PointCloud build(const std::vector<TrajectoryPoint>& trajectory, double voxel_m) const;

 private:
  struct ThinScan {
    TimeNs t_ns;
    std::vector<Point3f> points_body;
  };
  std::vector<ThinScan> scans_;
  Pose T_odom_body_kept_;
  TimeNs t_kept_ns_ = 0;
};

}  // namespace paloc

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
  /// A scan of which some of the points are kept.
  struct ThinScan {
    TimeNs t_ns = 0;
    std::vector<Point3f> points_body;
    std::vector<float> ages_s;  ///< as Scan::ages_s, if they are kept
    Vec3 sensor_position_body = Vec3::Zero();
  };

  /// `keep_ages`: for rays, which begin where the sensor was then.
  explicit ScanMap(bool keep_ages = false) : keep_ages_(keep_ages) {}

  void add(const OdometryFrame& frame);
  const std::vector<ThinScan>& scans() const { return scans_; }
  /// All points in the map's frame, one a voxel of `voxel_m` (m). Scans without a usable pose stay
  /// out.
  PointCloud build(const std::vector<TrajectoryPoint>& trajectory, double voxel_m) const;

 private:
  bool keep_ages_;
  std::vector<ThinScan> scans_;
  Pose T_odom_body_kept_;
  TimeNs t_kept_ns_ = 0;
};

/// The point of a trajectory at a scan's time, if it may be used.
const TrajectoryPoint* usablePoint(const std::vector<TrajectoryPoint>& trajectory, TimeNs t_ns);

}  // namespace paloc

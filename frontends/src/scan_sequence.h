#pragma once

#include <functional>
#include <vector>

#include "paloc/core/pose.h"
#include "paloc/frontends/lidar_frame.h"
#include "turn_fit.h"

namespace paloc {

/// Some scans in a row, thinned, and how the LiDAR moved over them, from the scans themselves:
/// point-to-plane registration of each to those before. It serves to compare the LiDAR's motion
/// with the IMU's; it is no odometry to build on.
class ScanSequence {
 public:
  static constexpr std::size_t kMostScans = 80;

  /// Takes a scan; false, and it is not taken, if it does not follow those before (a gap, the
  /// sequence is full) or holds too little.
  bool add(const LidarFrame& frame);

  /// Registers the scans, each moved to its end at even speed. False if they do not fit together.
  bool track();
  /// Registers them anew from what is known of the motion, each moved to its end by rotations
  /// R_from_to of the LiDAR that a gyroscope tells.
  using Rotation = std::function<Mat3(TimeNs from_ns, TimeNs to_ns)>;
  void trackWith(const Rotation& rotation);

  /// How the LiDAR turned from scan to scan, by the last tracking.
  void appendSteps(std::vector<TurnStep>& steps) const;

 private:
  struct TimedPoint {
    Point3f p;    // LiDAR frame at its own time
    float age_s;  // before the scan's end
  };
  struct ThinScan {
    TimeNs start_ns = 0, end_ns = 0;
    std::vector<TimedPoint> points;
  };

  double voxelSize() const;
  std::vector<Vec3> movedEvenly(const ThinScan& scan, const Pose& T_before_now, double dt_s) const;
  Vec3 velocityAt(std::size_t i) const;
  std::vector<Vec3> movedWith(const ThinScan& scan, const Vec3& velocity,
                              const Rotation& rotation) const;

  std::vector<ThinScan> scans_;
  std::vector<Pose> poses_;  // at the scans' ends, in the frame of the first
  std::vector<bool> registered_;
  bool by_gyro_ = false;
};

}  // namespace paloc

#pragma once

#include <optional>
#include <vector>

#include "paloc/core/imu_buffer.h"
#include "paloc/core/state.h"
#include "paloc/core/trajectory.h"

namespace paloc {

/// The trajectory at any instant between its first and its last node: integrated by the IMU from
/// the node before, and led smoothly onto the node after, so that it meets every node exactly in
/// pose and velocity. Where the IMU does not cover the interval, position is a cubic between the
/// nodes' poses and velocities, and rotation turns at an even rate.
class PALOC_EXPORT DenseTrajectory {
 public:
  /// `nodes` in order of time; `imu` covers them, or parts of them. `gravity_mps2`: local strength.
  /// Nodes further apart than `max_gap_s` (s) without IMU data between them are not bridged.
  DenseTrajectory(std::vector<TrajectoryPoint> nodes, ImuBuffer imu, double gravity_mps2,
                  double max_imu_gap_s, double max_gap_s);

  /// The pose, velocity and covariance at an instant; nothing before the first node, after the
  /// last, or in a gap. Of two nodes with different flags the worse one holds between them.
  std::optional<TrajectoryPoint> at(TimeNs t_ns) const;

  /// All instants of IMU samples between the first and the last node.
  std::vector<TimeNs> imuStamps() const;

 private:
  TrajectoryPoint between(const TrajectoryPoint& a, const TrajectoryPoint& b, TimeNs t_ns) const;
  std::optional<State> integrated(const State& from, TimeNs start_ns, TimeNs end_ns) const;

  std::vector<TrajectoryPoint> nodes_;
  ImuBuffer imu_;
  double gravity_mps2_, max_imu_gap_s_, max_gap_s_;
};

}  // namespace paloc

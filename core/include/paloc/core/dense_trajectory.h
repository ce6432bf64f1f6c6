#pragma once

#include <optional>
#include <vector>

#include "paloc/core/estimator_settings.h"
#include "paloc/core/imu_buffer.h"
#include "paloc/core/state_between.h"
#include "paloc/core/trajectory.h"

namespace paloc {

/// The trajectory at any instant between its first and its last node: integrated by the IMU from
/// the node before, and led smoothly onto the node after, so that it meets every node exactly in
/// pose, velocity and covariance. Where the IMU does not cover the interval, position is a cubic
/// between the nodes' poses and velocities, and rotation turns at an even rate.
///
/// The covariance between two nodes is that which a node there would have had: from the smoother's
/// joint covariance of both and the IMU's noise on either side (see StateBetween). It grows in the
/// middle of a long interval, as it should. Without a joint covariance (online, or no IMU data) the
/// nodes' covariances are interpolated and what the platform may have done meanwhile is added.
class PALOC_EXPORT DenseTrajectory {
 public:
  /// `result`'s trajectory and its joint covariances are used; `imu` covers it, or parts of it.
  /// Nodes further apart than `max_gap_s` (s) without IMU data between them are not bridged.
  DenseTrajectory(const Result& result, ImuBuffer imu, const EstimatorSettings& settings,
                  double max_gap_s);

  /// The pose, velocity and covariance at an instant; nothing before the first node, after the
  /// last, or in a gap. Of two nodes with different flags the worse one holds between them; further
  /// than `coasting_after_s` from both it is coasting at best.
  std::optional<TrajectoryPoint> at(TimeNs t_ns) const;

  /// All instants of IMU samples between the first and the last node.
  std::vector<TimeNs> imuStamps() const;

 private:
  TrajectoryPoint between(std::size_t before, TimeNs t_ns) const;
  std::optional<Preintegration> integrated(const State& from, TimeNs start_ns, TimeNs end_ns) const;
  std::vector<EdgeFactor> factorsOf(const Preintegration& imu) const;
  void setCovariance(std::size_t before, const State& x, TrajectoryPoint& point) const;
  void setFlag(const TrajectoryPoint& a, const TrajectoryPoint& b, TrajectoryPoint& point) const;

  std::vector<TrajectoryPoint> nodes_;
  std::vector<StateMatrix> covariances_, covariances_with_next_;
  ImuBuffer imu_;
  EstimatorSettings settings_;
  double max_gap_s_;
};

}  // namespace paloc

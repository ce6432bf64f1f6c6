#pragma once

#include <mrpt/poses/CPose3D.h>

#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "paloc/core/export.h"
#include "paloc/core/map_matcher.h"
#include "paloc/core/state.h"
#include "paloc/core/time.h"
#include "paloc/core/types.h"

namespace paloc {

/// How far a pose can be trusted.
enum class PoseFlag {
  kGood,        ///< fixed by the map in all six directions
  kDegenerate,  ///< the map leaves a direction open or weak: odometry and IMU fill it
  kCoasting,    ///< no map factor near: carried by odometry and IMU
  kLost,        ///< neither: do not use
};

/// One word for tables ("good").
PALOC_EXPORT std::string toString(PoseFlag flag);

/// One pose of the result, at the end of a scan.
struct TrajectoryPoint {
  TimeNs t_ns = 0;
  mrpt::poses::CPose3D T_map_body;
  Vec3 v_map = Vec3::Zero();          ///< m/s
  Vec3 bias_acc = Vec3::Zero();       ///< m/s2, body frame
  Vec3 bias_gyro = Vec3::Zero();      ///< rad/s, body frame
  Vec3 gravity_map = -Vec3::UnitZ();  ///< direction of gravity, points down
  Mat6 covariance = Mat6::Zero();  ///< tangent [position in map (m), rotation on the right (rad)]
  Vec3 v_sigma = Vec3::Zero();     ///< standard deviations of v_map (m/s)
  Vec3 bias_acc_sigma = Vec3::Zero();   ///< m/s2
  Vec3 bias_gyro_sigma = Vec3::Zero();  ///< rad/s
  Vec3 gravity_sigma = Vec3::Zero();    ///< of gravity_map's components
  PoseFlag flag = PoseFlag::kLost;
  /// Of its map factor; where there is none, all of class none, without axis.
  std::array<MatchDirection, 6> directions{};
};

/// What happened at one odometry frame: a row of diagnostics.csv.
struct FrameDiagnostics {
  TimeNs scan_start_ns = 0;
  TimeNs t_ns = 0;
  MapMatch match;  ///< refused, with the reason, where there was no map factor
  Vec3 guess_step_position = Vec3::Zero();  ///< match minus prediction, map frame (m)
  double guess_step_rotation = 0;           ///< rad
  bool has_odometry_factor = false;
  bool has_imu_factor = false;
  bool at_rest = false;
  int repairs = 0;
};

/// Counts of repairs that the smoothers made.
struct RepairCounts {
  std::uint64_t damped = 0;           ///< information was not positive definite: damping added
  std::uint64_t factors_dropped = 0;  ///< measurements that were not finite or absurd
  std::uint64_t reanchored = 0;       ///< the window had to start anew
  std::uint64_t total() const { return damped + factors_dropped + reanchored; }
  RepairCounts& operator+=(const RepairCounts& other) {
    damped += other.damped;
    factors_dropped += other.factors_dropped;
    reanchored += other.reanchored;
    return *this;
  }
};

/// What smoothing at the end changed in the associations with the map.
struct RematchCounts {
  std::size_t tried = 0;      ///< scans associated anew, since their poses had moved
  std::size_t gained = 0;     ///< refused before, used now
  std::size_t withdrawn = 0;  ///< used before, refused now
  std::size_t not_kept = 0;   ///< scans that could not be tried, for want of the memory allowed
};

/// Everything that a run of the estimator leaves.
struct Result {
  std::vector<TrajectoryPoint> trajectory;  ///< in order of time; the one to use
  /// Of the whole state of every point of `trajectory`, as the smoother tells it, and of each
  /// (rows) with the one after it (columns): for poses in between. Empty if it is the online one.
  std::vector<StateMatrix> covariances, covariances_with_next;
  std::vector<TrajectoryPoint> online;        ///< as it left the fixed-lag window
  std::vector<FrameDiagnostics> diagnostics;  ///< one per odometry frame, same order
  RepairCounts repairs;
  RematchCounts rematched;
  std::string no_trajectory_reason;  ///< one sentence if `trajectory` is empty
  bool batch_failed = false;  ///< `trajectory` is the online one, since smoothing at the end failed
  std::uint64_t frames_before_start = 0;  ///< odometry frames before the first pose was found
};

}  // namespace paloc

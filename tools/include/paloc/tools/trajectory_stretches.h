#pragma once

#include <cstddef>
#include <vector>

#include "paloc/core/trajectory.h"

namespace paloc {

/// Consecutive poses of one flag.
struct FlagStretch {
  PoseFlag flag = PoseFlag::kLost;
  std::size_t first = 0;  ///< index of its first pose
  std::size_t count = 0;
  TimeNs begin_ns = 0;  ///< of its first pose
  TimeNs end_ns = 0;    ///< of its last pose

  std::size_t last() const { return first + count - 1; }
};

/// The whole trajectory, cut where the flag changes.
std::vector<FlagStretch> flagStretches(const std::vector<TrajectoryPoint>& trajectory);

/// The standard deviation of position along its worst direction (m).
double positionSigma(const TrajectoryPoint& point);
double positionSigmaOf(const Mat6& pose_covariance);

/// The same of rotation (rad).
double rotationSigma(const TrajectoryPoint& point);

}  // namespace paloc

#pragma once

#include <cstddef>
#include <vector>

#include "paloc/core/pose.h"
#include "paloc/core/time.h"
#include "paloc/tools/normalized_errors.h"

namespace paloc {

/// A pose of an odometry with the true one.
struct OdometryPair {
  TimeNs t_ns = 0;
  Pose T_odom_body, T_map_body_true;
  bool continues = false;                 ///< from the pair before
  Mat6 motion_covariance = Mat6::Zero();  ///< since the pair before (see OdometryFrame)
};

/// How an odometry compares with the truth. Every error is of a motion: no alignment.
struct OdometryFigures {
  std::size_t frames = 0, breaks = 0;  ///< breaks: frames that do not continue, but for the first
  double length_m = 0;                 ///< of the true way
  double end_error_m = 0;              ///< with the first poses laid on each other
  double worst_m = 0;                  ///< the same, of any pose
  double drift_10m = 0;                ///< mean error over the segments of 10 m of way, as a share
  double drift_10m_max = 0;            ///< likewise the largest
  double rpe_frame_m = 0, rpe_frame_rad = 0;    ///< RMSE of the motion from frame to frame
  double rpe_second_m = 0, rpe_second_rad = 0;  ///< and over a second
  NormalizedErrors normalized;                  ///< of the motion from frame to frame
  std::size_t unusable = 0;                     ///< covariances that are not positive definite

  double endDrift() const { return length_m > 0 ? end_error_m / length_m : 0; }
};

OdometryFigures odometryFigures(const std::vector<OdometryPair>& pairs);

}  // namespace paloc

#pragma once

#include <filesystem>
#include <vector>

#include "paloc/core/imu_noise.h"
#include "paloc/core/imu_sample.h"
#include "paloc/core/pose.h"

namespace paloc {

/// A smoother problem: the measurements along one path, with the truth. The text format, a line per
/// item in order of time, `#` starts a comment, SI units, quaternions x y z w:
///
///   NOISE   acc gyr acc_bias_walk gyr_bias_walk            densities
///   IMU     t  ax ay az  wx wy wz                          holds until the next sample
///   STATE   k  t  x y z  qx qy qz qw  vx vy vz             node k; the truth, for scoring only
///   ODOM    i j  x y z  qx qy qz qw  sigma_rot sigma_pos   measured T_i^-1 T_j, j = i + 1
///   MAP     k  x y z  qx qy qz qw  sigma_rot sigma_pos     measured T_k in the map
///   MAPINFO k  x y z  qx qy qz qw  i11 i12 .. i66          the same with an information matrix
///
/// MAPINFO's matrix (upper triangle by rows) is of [position, rotation] errors on the right, in the
/// body frame: R <- R Exp(n_rot), t <- t + R n_pos. A MAP line of an older node than the last one
/// is a measurement that comes late.
struct SmootherProblem {
  struct MapMeasurement {
    std::size_t node = 0;
    Pose T_map_body;
    Mat6 information = Mat6::Zero();  ///< tangent [position in the map, rotation on the right]
  };
  struct OdometryMeasurement {
    Pose T_i_j;
    Mat6 covariance = Mat6::Zero();  ///< [position in body i, rotation on the right]
  };
  struct Node {
    TimeNs t_ns = 0;
    Pose T_map_body_true;
    Vec3 v_map_true = Vec3::Zero();
    std::vector<ImuSample> imu;                 ///< since the node before, in order
    std::vector<OdometryMeasurement> odometry;  ///< from the node before
    std::vector<MapMeasurement> map;            ///< that came with this node, or late
  };

  ImuNoise noise;
  std::vector<Node> nodes;
};

/// Reads a problem. Throws IoError (file, line, field) on anything that is not as described.
SmootherProblem readSmootherProblem(const std::filesystem::path& file);

}  // namespace paloc

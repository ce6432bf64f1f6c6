#pragma once

#include <array>
#include <vector>

#include "paloc/core/pose.h"
#include "paloc/core/trajectory.h"

namespace paloc {

/// A pose that was estimated, and what is true.
struct CorridorPose {
  TimeNs t_ns = 0;
  Pose truth, estimate;
  Mat6 covariance = Mat6::Zero();  ///< tangent [position in the map (m), rotation on the right]
  PoseFlag flag = PoseFlag::kGood;
};

/// Where a map leaves its axis free: a stretch of a straight way.
struct FreeStretch {
  Vec3 axis_map = Vec3::UnitX();  ///< unit vector
  double begin_m = 0, end_m = 0;  ///< along it, from the map's origin

  double along(const Vec3& position_map) const { return axis_map.dot(position_map); }
  bool holds(const Vec3& position_map) const {
    const double x = along(position_map);
    return x >= begin_m && x <= end_m;
  }
};

/// How well one trajectory went through the stretch. Along: position along the axis; across: the
/// two at right angles to it together.
struct CorridorFigures {
  double along_at_end_m = 0;  ///< error of the last pose inside
  double along_max_m = 0;     ///< largest inside
  double across_max_m = 0;    ///< the same
  double across_rms_m = 0;
  double exit_step_m =
      0;  ///< largest change of the error from pose to pose, from the last inside on
  double along_max_sigmas = 0;  ///< largest |error| / sigma, of all poses, outside too
  double nees_along = 0;        ///< mean of squares of the same, inside
  double nees_across = 0;       ///< per degree of freedom, inside
  std::size_t poses = 0;        ///< inside
  std::array<std::size_t, 4> inside{}, outside{};  ///< poses by flag (PoseFlag's order)
};

/// Poses in order of time that pass through the stretch once.
CorridorFigures corridorFigures(const std::vector<CorridorPose>& poses, const FreeStretch& stretch);

/// By how much an odometry is off along the axis at the last pose inside, when it is laid on the
/// truth at the first one (m). Both are poses of the body at the same times.
double odometryDrift(const std::vector<Pose>& truth, const std::vector<Pose>& odometry,
                     const FreeStretch& stretch);

}  // namespace paloc

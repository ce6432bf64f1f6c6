#pragma once

#include <tbb/task_arena.h>

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "paloc/core/pose.h"
#include "paloc/map/degeneracy.h"
#include "plane_search.h"

namespace paloc {

/// Asks whether a scan would lie worse on the map with the body moved, its planes sought anew
/// there. A few points at an edge are matched with whatever face is near and then seem to hold the
/// body; but moved, they lie as well on other faces.
class MotionProbe {
 public:
  /// `matches` are those at the pose, one a point, and `scale` that of their sigmas (robust, at
  /// least 1). All are to outlive the probe.
  MotionProbe(const PlaneSearch& planes, std::span<const Correspondence> matches,
              const Pose& T_local_body, double scale, double within_m, tbb::task_arena& arena)
      : planes_(planes),
        matches_(matches),
        pose_(T_local_body),
        scale_(scale),
        within_m_(within_m),
        arena_(arena) {}

  struct Answer {
    double clearness = 0;
    std::optional<Pose> better;
  };
  /// How clearly the scan lies worse whichever way along the motion (body frame) it is moved, by 6
  /// to 15 cm at the points: below 0 it lies better somewhere, from 1 on it lies clearly worse
  /// everywhere. And where it lies clearly better, if anywhere.
  ///
  /// Of rho(z) = z^2 / (1 + z^2 / k^2), z the residual in sigmas, k the kernel's width, the changes
  /// are summed over the points that see the motion here: twice the logarithm of how many times
  /// likelier they are here. Clearly: 300,000 times. A point that finds no plane there counts as
  /// one far off it.
  Answer ask(const Motion& motion) const;

 private:
  /// A matched point, and by how many sigmas the motion moves it off its plane.
  struct Seeing {
    double sigmas = 0;
    std::uint32_t point = 0;
  };
  std::vector<Seeing> pointsThatSee(const Motion& motion, double length) const;
  double changeAt(const Pose& pose, std::span<const Seeing> points) const;
  double changeOf(std::span<const Seeing> points, const Pose& pose) const;

  const PlaneSearch& planes_;
  std::span<const Correspondence> matches_;
  const Pose& pose_;
  double scale_, within_m_;
  tbb::task_arena& arena_;
};

}  // namespace paloc

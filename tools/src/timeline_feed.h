#pragma once

#include <algorithm>
#include <cstddef>

#include "paloc/tools/motion_observations.h"
#include "paloc/tools/synth_timeline.h"

namespace paloc::synth {

/// Gives the IMU samples and odometry poses of a timeline as observations, in the order of their
/// stamps, in portions: those before each scan.
class TimelineFeed {
 public:
  explicit TimelineFeed(const Timeline& timeline) : timeline_(timeline) {}

  /// Calls give(observation) for all that are left before `end_ns`.
  template <typename Give>
  void until(TimeNs end_ns, const Give& give) {
    for (;;) {
      const TimeNs imu = imu_ < timeline_.imu.size() ? timeline_.imu[imu_].sample.t_ns : end_ns;
      const TimeNs odometry =
          odometry_ < timeline_.odometry.size() ? timeline_.odometry[odometry_].t_ns : end_ns;
      if (std::min(imu, odometry) >= end_ns) return;
      if (imu <= odometry) {
        give(imuObservation(timeline_.imu[imu_++].sample, "imu"));
      } else {
        give(poseObservation(timeline_.odometry[odometry_++], "odometry"));
      }
    }
  }

 private:
  const Timeline& timeline_;
  std::size_t imu_ = 0, odometry_ = 0;  // the next to give
};

}  // namespace paloc::synth

#pragma once

#include "paloc/tools/synth_odometry.h"
#include "paloc/tools/synth_recording.h"
#include "paloc/tools/synth_sensor.h"
#include "paloc/tools/synth_walk.h"

namespace paloc::synth {

/// When what is measured, and the truth at those times.
struct Timeline {
  explicit Timeline(Motion motion_of_body) : motion(std::move(motion_of_body)) {}

  Motion motion;
  TimeNs first_scan_ns = 0;  ///< the first column of the first scan
  TimeNs period_ns = 0;
  std::size_t scans = 0;
  std::vector<StampedPose> truth;     ///< T_map_body at the end of each scan
  std::vector<StampedPose> odometry;  ///< T_odom_body at the same times
  std::vector<ImuTruth> imu;          ///< from 0.1 s before the first scan to 0.1 s after the last
  double length_m = 0;
  std::vector<std::string> notes;

  TimeNs scanStart(std::size_t i) const {
    return first_scan_ns + static_cast<TimeNs>(i) * period_ns;
  }
};

/// Throws UsageError for a duration too short for one scan, IoError for a trajectory that is.
Timeline makeTimeline(const SynthSettings& settings, const std::vector<Vec3>& route,
                      const SensorModel& sensor);

}  // namespace paloc::synth

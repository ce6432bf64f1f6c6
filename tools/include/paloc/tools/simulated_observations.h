#pragma once

#include <mrpt/obs/CObservation.h>

#include <functional>

#include "paloc/tools/synth_sensor.h"
#include "paloc/tools/synth_timeline.h"

namespace paloc::synth {

/// Simulates a recording that nobody stores: gives its observations (LiDAR, IMU, odometry) in the
/// order of their stamps. Scans are made some at a time, on all threads; while `give` is called no
/// other thread works. `progress` is told the share of the work done, 0..1.
void simulateObservations(const Timeline& timeline, const LidarSimulator& lidar,
                          const std::function<void(const mrpt::obs::CObservation&)>& give,
                          const std::function<void(double)>& progress);

}  // namespace paloc::synth

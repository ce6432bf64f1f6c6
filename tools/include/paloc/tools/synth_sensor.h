#pragma once

#include <numbers>
#include <string>
#include <vector>

#include "paloc/core/time.h"
#include "paloc/frontends/CObservationLidarScan.h"
#include "paloc/tools/synth_motion.h"
#include "paloc/tools/synth_surroundings.h"

namespace paloc::synth {

/// A LiDAR whose columns fire one after the other, clockwise as seen from above, all beams of a
/// column at once. One that spins goes round once in a period, beginning ahead (the sensor's +x); a
/// solid-state one sweeps its field of view from left to right and starts again.
struct SensorModel {
  std::string name;
  std::vector<double> elevation_rad;        ///< one per beam, upwards; the ring is the index
  double first_azimuth_rad = 0;             ///< of column 0, from ahead to the left
  double field_rad = 2 * std::numbers::pi;  ///< from column 0 to where the next one would follow
  int columns = 0;                          ///< in the field
  TimeNs period_ns = kNsPerSecond / 10;
  double min_range_m = 0.5;
  double max_range_m = 120;     ///< at which a target of 10 % reflectivity still returns
  double range_noise_m = 0.03;  ///< standard deviation

  /// When column `i` fires, after the first (ns, a multiple of MRPT's 100 ns tick).
  TimeNs columnDelay(int i) const { return (i * period_ns / columns + 50) / 100 * 100; }
  double columnAzimuth(int i) const { return first_azimuth_rad - field_rad * i / columns; }
  TimeNs duration() const { return columnDelay(columns - 1); }
};

/// "os1-128", "vlp-16", "xt-32", "solid-state".
std::vector<std::string> sensorNames();
/// Throws UsageError, naming those that exist, for an unknown name.
SensorModel makeSensor(const std::string& name);

/// Simulates scans of a sensor on a moving body.
class LidarSimulator {
 public:
  /// All references must outlive the simulator.
  LidarSimulator(const SensorModel& sensor, const Pose& T_body_lidar, const SceneMesh& mesh,
                 const Surroundings& surroundings, const Motion& motion, std::uint64_t seed);

  /// The scan whose first column fires at `stamp_ns`, with valid returns only. `index` picks its
  /// random numbers. Any number of threads may call it.
  obs::CObservationLidarScan::Ptr scan(std::uint64_t index, TimeNs stamp_ns) const;

 private:
  const SensorModel& sensor_;
  Pose T_body_lidar_;
  const SceneMesh& mesh_;
  const Surroundings& surroundings_;
  const Motion& motion_;
  std::uint64_t seed_;
};

}  // namespace paloc::synth

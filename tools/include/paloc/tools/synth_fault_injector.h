#pragma once

#include <mrpt/obs/CObservationIMU.h>

#include <functional>
#include <vector>

#include "paloc/core/time.h"
#include "paloc/frontends/CObservationLidarScan.h"
#include "paloc/tools/synth_fault.h"

namespace paloc::synth {

/// Spoils the observations of a simulated recording, one by one, as they would come to be wrong.
/// Several faults act one after the other, in the order given.
class FaultInjector {
 public:
  /// `start_ns`: the first scan's start, from which the faults' times count.
  FaultInjector(std::vector<Fault> faults, TimeNs start_ns)
      : faults_(std::move(faults)), start_ns_(start_ns) {}

  using Give = std::function<void(const mrpt::obs::CObservation&)>;

  /// Calls give() with what becomes of the observation: itself or a changed copy, once, twice, or
  /// not at all.
  void pass(const mrpt::obs::CObservation& observation, const Give& give);

 private:
  void passImu(mrpt::obs::CObservationIMU imu, const Give& give);
  void passScan(obs::CObservationLidarScan scan, const Give& give);
  void passOther(const mrpt::obs::CObservation& observation, const Give& give);
  TimeNs rewound(TimeNs t_ns) const;
  bool inGap(FaultKind kind, TimeNs t_ns) const;

  std::vector<Fault> faults_;
  TimeNs start_ns_;
  std::uint64_t imu_samples_ = 0, scans_ = 0;
  TimeNs next_thinned_ns_ = 0;  // of the samples that a lower rate leaves
};

}  // namespace paloc::synth

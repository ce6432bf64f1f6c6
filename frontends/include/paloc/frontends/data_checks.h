#pragma once

#include <mrpt/obs/CObservation.h>

#include <memory>
#include <vector>

#include "paloc/core/export.h"
#include "paloc/frontends/finding.h"
#include "paloc/frontends/frontend_settings.h"
#include "paloc/frontends/motion_comparison.h"

namespace paloc {

/// Looks for what goes wrong in sensor set-ups and recordings: units, axes, clocks, rates, gaps,
/// stamps, point times. Observations in, in the order of the recording; findings out. Memory and
/// time for the scans are bounded: their motion is looked at over five minutes at most.
class PALOC_EXPORT DataChecks {
 public:
  enum class Extent {
    kCheap,  ///< of the scans one in fifty; motion only of a recorded odometry
    kFull,   ///< also registers scans to compare their motion with the IMU's
  };

  /// The labels in `settings` choose the streams whose motions are compared; the first of each
  /// kind without. Throws IoError if there is an odometry file that cannot be read.
  DataChecks(const FrontendSettings& settings, Extent extent);
  ~DataChecks();
  DataChecks(const DataChecks&) = delete;
  DataChecks& operator=(const DataChecks&) = delete;

  void add(const mrpt::obs::CObservation& observation);
  /// No more observations come. Needed before what follows.
  void finish();

  /// In the order: notes last, else as the streams came.
  const Findings& findings() const;
  /// The figures behind those of units, axes and clocks.
  const std::vector<MotionComparison>& motions() const;
  /// How far nine tenths of the returns are at most (m); 0 if no scan was looked at.
  double scanReach() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace paloc

#pragma once

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "paloc/frontends/scan_tracker.h"
#include "scan_inertia.h"

namespace paloc {

/// What trackers of LiDAR and IMU share: the IMU's word on each scan, and what to tell of it.
class InertialTracker : public ScanTracker {
 public:
  explicit InertialTracker(const FrontendSettings& settings)
      : settings_(settings), inertia_(settings) {}

  std::string whyRefused() const override { return "no IMU data during it"; }
  std::string whoseMotionWhereCoasted() const override { return "the IMU's"; }
  std::string need() const override { return "needs an IMU that covers its first scan"; }
  std::vector<std::string> notes(int scans) const override;

 protected:
  /// `factor`: by how much the variance of the IMU's noise was raised.
  void keepWorst(double factor) {
    worst_imu_noise_ = std::max(worst_imu_noise_, std::sqrt(factor));
  }

  FrontendSettings settings_;
  ScanInertia inertia_;

 private:
  double worst_imu_noise_ = 1;
};

}  // namespace paloc

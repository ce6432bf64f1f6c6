#pragma once

#include "paloc/core/export.h"
#include "paloc/core/types.h"

namespace paloc {

/// Whether the IMU is as good as its settings say, from how far the scans move what it predicts.
class PALOC_EXPORT ImuAgreement {
 public:
  /// Takes the step of an update (6, position and rotation) and the covariance that the update took
  /// away.
  void compare(const Vec6& step, const Mat6& gained);
  /// The step's squared norm in that covariance, a degree of freedom: 1 is expected.
  static double squared(const Vec6& step, const Mat6& gained);

  /// By how much the variance of the IMU's noise is to be raised, so that the steps of the updates
  /// are as large as expected: 1 for an IMU that is as good as the settings say.
  double imuFactor() const { return imu_factor_; }
  /// By how much the variance of motions is: where IMU and scans disagree by more than they should,
  /// over the last seconds.
  double motionFactor() const { return agrees() ? 1 : disagreement_ - 1; }
  bool agrees() const { return disagreement_ <= 2; }

 private:
  double imu_factor_ = 1, disagreement_ = 1;  // variances, as ratios
};

}  // namespace paloc

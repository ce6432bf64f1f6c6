#pragma once

#include <optional>

#include "paloc/core/export.h"
#include "paloc/core/imu_sample.h"

namespace paloc {

/// Keeps the direction of up in the body frame: turned with the gyroscope, drawn slowly towards the
/// accelerometer (a complementary filter). Good for deskewing, where 0.02 rad wrong cost a quarter
/// of a millimetre in a scan of 0.1 s; not for more.
class PALOC_EXPORT GravityTracker {
 public:
  void add(const ImuSample& sample);

  /// Unit vector that points up, in the body frame at the newest sample; nothing before the first.
  const std::optional<Vec3>& up() const { return up_; }

 private:
  std::optional<Vec3> up_;
  ImuSample last_;
  double age_s_ = 0;
};

}  // namespace paloc

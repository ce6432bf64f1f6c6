#pragma once

#include <algorithm>
#include <optional>

#include "paloc/core/time.h"

namespace paloc {

/// Stamps of an IMU by the clock of a LiDAR, while the offset between them becomes known: it
/// changes evenly, so that time never runs backwards. An offset of 0 leaves stamps as they are.
class ImuClock {
 public:
  /// At the IMU's time `imu_ns` it is later than the LiDAR's by `late_ns`; stamps until there come
  /// next.
  void reach(TimeNs imu_ns, TimeNs late_ns) {
    from_ = last_.value_or(Knot{imu_ns, late_ns});
    to_ = {imu_ns, late_ns};
  }

  /// By the LiDAR's clock; stamps come in order of time.
  TimeNs toLidar(TimeNs imu_ns) {
    TimeNs late_ns = to_.late_ns;
    if (imu_ns < to_.imu_ns && from_.imu_ns < to_.imu_ns && from_.late_ns != to_.late_ns) {
      const double done = static_cast<double>(imu_ns - from_.imu_ns) /
                          static_cast<double>(to_.imu_ns - from_.imu_ns);
      late_ns = from_.late_ns +
                static_cast<TimeNs>(done * static_cast<double>(to_.late_ns - from_.late_ns));
    }
    if (last_) late_ns = std::min(late_ns, imu_ns - (last_->imu_ns - last_->late_ns) - 1);
    last_ = Knot{imu_ns, late_ns};
    return imu_ns - late_ns;
  }

 private:
  struct Knot {
    TimeNs imu_ns = 0, late_ns = 0;
  };
  Knot from_, to_;
  std::optional<Knot> last_;  // stamp
};

}  // namespace paloc

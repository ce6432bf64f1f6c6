#pragma once

#include <deque>
#include <optional>
#include <vector>

#include "paloc/core/imu_sample.h"
#include "paloc/core/preintegration.h"

namespace paloc {

/// The IMU samples of the recent past, integrated between any two instants: between samples the
/// measurements are taken as linear in time, at the ends they are interpolated.
class PALOC_EXPORT ImuBuffer {
 public:
  /// Takes a sample. False, and nothing is kept, if it is not newer than the last one or not
  /// finite.
  bool add(const ImuSample& sample);

  /// Preintegrates from `start_ns` to `end_ns`. Nothing if the samples do not cover the interval:
  /// more than `max_gap_s` (s) without one, also at its ends.
  std::optional<Preintegration> integrate(TimeNs start_ns, TimeNs end_ns, double max_gap_s,
                                          const ImuNoise& noise, const Vec3& bias_acc,
                                          const Vec3& bias_gyro) const;

  /// Forgets samples that no interval starting at `t_ns` or later needs.
  void forgetBefore(TimeNs t_ns);

  /// The stamps of the samples from `start_ns` to `end_ns`, both included.
  std::vector<TimeNs> stamps(TimeNs start_ns, TimeNs end_ns) const;

  /// The samples from `start_ns` to `end_ns`, both included.
  std::vector<ImuSample> between(TimeNs start_ns, TimeNs end_ns) const;

  bool empty() const { return samples_.empty(); }
  std::size_t size() const { return samples_.size(); }

 private:
  ImuSample at(std::size_t after, TimeNs t_ns) const;

  std::deque<ImuSample> samples_;
};

}  // namespace paloc

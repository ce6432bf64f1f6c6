#pragma once

#include <deque>
#include <optional>
#include <vector>

#include "paloc/core/imu_sample.h"
#include "paloc/frontends/gravity_tracker.h"

namespace paloc {

/// IMU samples that wait to be given out, and those given out that a scan may still need.
class ImuQueue {
 public:
  explicit ImuQueue(double max_gap_s) : max_gap_s_(max_gap_s) {}

  /// The sample must be later than those before.
  void add(const ImuSample& sample);

  bool empty() const { return samples_.empty(); }
  TimeNs newestNs() const {
    return samples_.back().sample.t_ns;
  }  ///< of a buffer that is not empty

  /// The next sample to give out, if there is one and the last one given out is before `until_ns`:
  /// so that the first sample at or after `until_ns` is the last to come.
  std::optional<ImuSample> takeUntil(TimeNs until_ns);

  /// The samples from the last at or before `start_ns` to the first at or after `end_ns`; none if
  /// they do not reach that far or have a gap.
  std::vector<ImuSample> covering(TimeNs start_ns, TimeNs end_ns) const;

  /// Direction of up (unit vector, body frame) at the first sample at or after a time.
  std::optional<Vec3> upAt(TimeNs t_ns) const;

  /// Forgets what was given out and lies before a time, except for the last such sample.
  void forgetBefore(TimeNs t_ns);

  int gaps() const { return gaps_; }
  double longestGapS() const { return longest_gap_s_; }
  TimeNs longestGapNs() const { return longest_gap_ns_; }  ///< when it began

 private:
  struct Entry {
    ImuSample sample;
    Vec3 up_body;
  };

  std::size_t lowerBound(TimeNs t_ns) const;

  double max_gap_s_;
  std::deque<Entry> samples_;
  std::size_t given_ = 0;  // how many of samples_ were given out
  std::optional<TimeNs> last_given_ns_;
  GravityTracker gravity_;
  int gaps_ = 0;
  double longest_gap_s_ = 0;
  TimeNs longest_gap_ns_ = 0;
};

}  // namespace paloc

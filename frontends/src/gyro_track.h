#pragma once

#include <vector>

#include "paloc/core/imu_sample.h"
#include "paloc/core/so3.h"

namespace paloc {

/// The rotation that a gyroscope tells, between any two instants. Between samples the rate is taken
/// as linear in time. No bias is taken out.
class GyroTrack {
 public:
  explicit GyroTrack(double max_gap_s) : max_gap_s_(max_gap_s) {}

  /// The sample must be later than those before.
  void add(const ImuSample& sample);

  /// Whether samples without a gap reach from one time to the other.
  bool covers(TimeNs from_ns, TimeNs to_ns) const;

  /// Rotation of the IMU since the track's beginning. Held at the ends.
  Mat3 rotationAt(TimeNs t_ns) const;
  /// R_from_to: takes vectors in the IMU's frame at `to_ns` to that at `from_ns`.
  Mat3 rotation(TimeNs from_ns, TimeNs to_ns) const {
    return rotationAt(from_ns).transpose() * rotationAt(to_ns);
  }
  /// Mean rate over an interval (rad/s if that is the sensor's unit), in the IMU's frame at its
  /// end; at one instant if the interval is empty.
  Vec3 meanRate(TimeNs from_ns, TimeNs to_ns) const;

  /// All the turning between two times, whatever its direction (rad). Held at the ends.
  double path(TimeNs from_ns, TimeNs to_ns) const { return pathAt(to_ns) - pathAt(from_ns); }

  /// The track of an IMU whose readings are `m` times these.
  GyroTrack transformed(const Mat3& m) const;

  bool empty() const { return entries_.empty(); }
  TimeNs oldestNs() const { return entries_.front().t_ns; }
  TimeNs newestNs() const { return entries_.back().t_ns; }

 private:
  struct Entry {
    TimeNs t_ns = 0;
    Vec3 omega;
    Mat3 R;           // since the beginning
    double path = 0;  // likewise
    int piece = 0;    // counts gaps
  };

  std::size_t lowerBound(TimeNs t_ns) const;
  double pathAt(TimeNs t_ns) const;

  double max_gap_s_;
  std::vector<Entry> entries_;
};

}  // namespace paloc

#pragma once

#include <array>

#include "paloc/core/imu_buffer.h"
#include "paloc/core/pose.h"

namespace paloc {

/// How the IMU alone says that the body moved during a scan, seen from a frame in free fall.
///
/// With S the end of the scan and tau = S - t, the position in the odom frame of a point q that was
/// measured at t in the body frame is, exactly,
///
///   y = p_S - v_S tau + g tau^2 / 2 + R_S u,   u = T_fall(t) q,
///
/// where u follows from rates and forces alone: it needs neither pose nor velocity, and an update
/// of these moves all points of the scan without another integration. (FAST-LIO2's backward
/// propagation, section V-A, moves points with the state as predicted.)
class PALOC_EXPORT FreeFallScan {
 public:
  /// Integrates from `start_ns` to `end_ns`. `ok()` is false where the samples do not cover these.
  FreeFallScan(const ImuBuffer& imu, TimeNs start_ns, TimeNs end_ns, double max_gap_s,
               const Vec3& bias_acc, const Vec3& bias_gyro);

  bool ok() const { return ok_; }

  /// u of a point q (m, body frame at its time), `age_s` before the end of the scan.
  Vec3 place(const Vec3& point_body, double age_s) const;
  /// The body in the frame in free fall, T_fall(t): the identity at the end of the scan.
  Pose bodyAt(double age_s) const;

  double durationS() const { return duration_s_; }
  /// How fast u of a point moves where the point is measured later than it was (m/s); zero for a
  /// scan without duration, as are the means.
  Vec3 velocity(const Vec3& point_body, double age_s) const;
  /// Means over the scan, in the body frame at its end, where rate and force are even: rate
  /// (rad/s) and specific force (m/s2).
  Vec3 meanRate() const;
  Vec3 meanForce() const;

 private:
  static constexpr int kSlots = 32;

  double duration_s_ = 0, per_s_ = 0;
  bool ok_ = true;
  std::array<Pose, kSlots + 1> poses_;  // evenly, from the start to the end
};

}  // namespace paloc

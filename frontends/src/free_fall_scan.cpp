#include "paloc/frontends/free_fall_scan.h"

#include <algorithm>

namespace paloc {

// Forward from the start: R~, v~, p~ of the specific force alone. At the end, with these of index
// S: u = R~_S^T (R~ q + p~ - p~_S + v~_S tau).
FreeFallScan::FreeFallScan(const ImuBuffer& imu, TimeNs start_ns, TimeNs end_ns, double max_gap_s,
                           const Vec3& bias_acc, const Vec3& bias_gyro)
    : duration_s_(secondsBetween(start_ns, end_ns)) {
  if (duration_s_ <= 0) return;
  per_s_ = kSlots / duration_s_;
  Vec3 v = Vec3::Zero();
  const auto timeOf = [&](std::size_t slot) {
    return start_ns + (end_ns - start_ns) * static_cast<TimeNs>(slot) / kSlots;
  };
  for (std::size_t slot = 0; slot < kSlots; ++slot) {
    const auto step =
        imu.integrate(timeOf(slot), timeOf(slot + 1), max_gap_s, {}, bias_acc, bias_gyro);
    if (!step) {
      ok_ = false;
      return;
    }
    const Pose& from = poses_[slot];
    poses_[slot + 1] = {from.position + v * step->dt_s + from.rotation * step->delta_p,
                        from.rotation * step->delta_R};
    v += from.rotation * step->delta_v;
  }
  const Pose end = poses_[kSlots];
  for (std::size_t slot = 0; slot <= kSlots; ++slot) {
    const double age_s = secondsBetween(timeOf(slot), end_ns);
    Pose& pose = poses_[slot];
    pose = {end.rotation.transpose() * (pose.position - end.position + v * age_s),
            end.rotation.transpose() * pose.rotation};
  }
}

Vec3 FreeFallScan::place(const Vec3& point_body, double age_s) const {
  const double x = std::clamp((duration_s_ - age_s) * per_s_, 0.0, static_cast<double>(kSlots));
  const auto slot = std::min(static_cast<std::size_t>(x), static_cast<std::size_t>(kSlots - 1));
  const double ratio = x - static_cast<double>(slot);
  const Vec3 from = poses_[slot] * point_body;
  return from + ratio * (poses_[slot + 1] * point_body - from);
}

Pose FreeFallScan::bodyAt(double age_s) const {
  const double x = std::clamp((duration_s_ - age_s) * per_s_, 0.0, static_cast<double>(kSlots));
  const auto slot = std::min(static_cast<std::size_t>(x), static_cast<std::size_t>(kSlots - 1));
  return interpolate(poses_[slot], poses_[slot + 1], x - static_cast<double>(slot));
}

Vec3 FreeFallScan::velocity(const Vec3& point_body, double age_s) const {
  const double x = std::clamp((duration_s_ - age_s) * per_s_, 0.0, static_cast<double>(kSlots));
  const auto slot = std::min(static_cast<std::size_t>(x), static_cast<std::size_t>(kSlots - 1));
  return per_s_ * (poses_[slot + 1] * point_body - poses_[slot] * point_body);
}

Vec3 FreeFallScan::meanRate() const {
  if (duration_s_ <= 0) return Vec3::Zero();
  return so3::log(poses_.front().rotation) / -duration_s_;
}

// Of an even force f the body is at f tau^2 / 2.
Vec3 FreeFallScan::meanForce() const {
  if (duration_s_ <= 0) return Vec3::Zero();
  return 2 / (duration_s_ * duration_s_) * poses_.front().position;
}

}  // namespace paloc

#include "gyro_track.h"

#include <algorithm>

namespace paloc {

void GyroTrack::add(const ImuSample& sample) {
  if (entries_.empty()) {
    entries_.push_back({sample.t_ns, sample.omega_body, Mat3::Identity(), 0, 0});
    return;
  }
  const Entry& last = entries_.back();
  const double dt_s = secondsBetween(last.t_ns, sample.t_ns);
  const Vec3 turn = 0.5 * dt_s * (last.omega + sample.omega_body);
  entries_.push_back({sample.t_ns, sample.omega_body, so3::normalized(last.R * so3::exp(turn)),
                      last.path + turn.norm(), last.piece + (dt_s > max_gap_s_ ? 1 : 0)});
}

std::size_t GyroTrack::lowerBound(TimeNs t_ns) const {
  const auto found = std::lower_bound(entries_.begin(), entries_.end(), t_ns,
                                      [](const Entry& entry, TimeNs t) { return entry.t_ns < t; });
  return static_cast<std::size_t>(found - entries_.begin());
}

bool GyroTrack::covers(TimeNs from_ns, TimeNs to_ns) const {
  if (entries_.empty() || from_ns < oldestNs() || to_ns > newestNs()) return false;
  const std::size_t first = lowerBound(from_ns + 1), last = lowerBound(to_ns);
  return entries_[first - 1].piece == entries_[last].piece;
}

Mat3 GyroTrack::rotationAt(TimeNs t_ns) const {
  const std::size_t next = lowerBound(t_ns);
  if (next == 0) return entries_.front().R;
  if (next == entries_.size()) return entries_.back().R;
  const Entry &a = entries_[next - 1], &b = entries_[next];
  const double step_s = secondsBetween(a.t_ns, b.t_ns), s = secondsBetween(a.t_ns, t_ns);
  return a.R * so3::exp(a.omega * s + (b.omega - a.omega) * (s * s / (2 * step_s)));
}

double GyroTrack::pathAt(TimeNs t_ns) const {
  const std::size_t next = lowerBound(t_ns);
  if (next == 0) return entries_.front().path;
  return next == entries_.size() ? entries_.back().path : entries_[next].path;
}

Vec3 GyroTrack::meanRate(TimeNs from_ns, TimeNs to_ns) const {
  constexpr TimeNs kInstant = 1'000'000;  // ns
  if (to_ns - from_ns < kInstant) {
    from_ns = (from_ns + to_ns) / 2 - kInstant / 2;
    to_ns = from_ns + kInstant;
  }
  return -so3::log(rotation(to_ns, from_ns)) / secondsBetween(from_ns, to_ns);
}

GyroTrack GyroTrack::transformed(const Mat3& m) const {
  GyroTrack result(max_gap_s_);
  for (const Entry& entry : entries_) {
    ImuSample sample;
    sample.t_ns = entry.t_ns;
    sample.omega_body = m * entry.omega;
    result.add(sample);
  }
  return result;
}

}  // namespace paloc

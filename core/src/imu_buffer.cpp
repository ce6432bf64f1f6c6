#include "paloc/core/imu_buffer.h"

#include <algorithm>

namespace paloc {

bool ImuBuffer::add(const ImuSample& sample) {
  if (!sample.acc_body.allFinite() || !sample.omega_body.allFinite()) return false;
  if (!samples_.empty() && sample.t_ns <= samples_.back().t_ns) return false;
  samples_.push_back(sample);
  return true;
}

// The measurement at t, where `after` is the index of the first sample later than t. Beyond the
// ends the outermost sample holds.
ImuSample ImuBuffer::at(std::size_t after, TimeNs t_ns) const {
  ImuSample result = after == 0 ? samples_.front() : samples_[after - 1];
  if (after > 0 && after < samples_.size()) {
    const ImuSample& a = samples_[after - 1];
    const ImuSample& b = samples_[after];
    const double ratio = secondsBetween(a.t_ns, t_ns) / secondsBetween(a.t_ns, b.t_ns);
    result.acc_body = a.acc_body + ratio * (b.acc_body - a.acc_body);
    result.omega_body = a.omega_body + ratio * (b.omega_body - a.omega_body);
  }
  result.t_ns = t_ns;
  return result;
}

std::optional<Preintegration> ImuBuffer::integrate(TimeNs start_ns, TimeNs end_ns, double max_gap_s,
                                                   const ImuNoise& noise, const Vec3& bias_acc,
                                                   const Vec3& bias_gyro) const {
  if (samples_.empty() || end_ns <= start_ns) return std::nullopt;
  const auto later = [](TimeNs t, const ImuSample& s) { return t < s.t_ns; };
  const auto first = std::upper_bound(samples_.begin(), samples_.end(), start_ns, later);
  auto k = static_cast<std::size_t>(first - samples_.begin());

  const TimeNs max_gap_ns = nsFromSeconds(max_gap_s);
  if (k == 0 && samples_.front().t_ns - start_ns > max_gap_ns) return std::nullopt;
  Preintegration result(noise, bias_acc, bias_gyro);
  ImuSample from = at(k, start_ns);
  TimeNs last_measured = k == 0 ? samples_.front().t_ns : samples_[k - 1].t_ns;
  while (from.t_ns < end_ns) {
    const bool inside = k < samples_.size() && samples_[k].t_ns < end_ns;
    const ImuSample to = inside ? samples_[k] : at(k, end_ns);
    const TimeNs next_measured = k < samples_.size() ? samples_[k].t_ns : end_ns;
    if (next_measured - last_measured > max_gap_ns) return std::nullopt;
    result.integrate(0.5 * (from.acc_body + to.acc_body), 0.5 * (from.omega_body + to.omega_body),
                     secondsBetween(from.t_ns, to.t_ns));
    last_measured = next_measured;
    from = to;
    if (inside) ++k;
  }
  return result;
}

std::vector<TimeNs> ImuBuffer::stamps(TimeNs start_ns, TimeNs end_ns) const {
  std::vector<TimeNs> result;
  for (const ImuSample& s : samples_) {
    if (s.t_ns >= start_ns && s.t_ns <= end_ns) result.push_back(s.t_ns);
  }
  return result;
}

std::vector<ImuSample> ImuBuffer::between(TimeNs start_ns, TimeNs end_ns) const {
  std::vector<ImuSample> result;
  for (const ImuSample& s : samples_) {
    if (s.t_ns >= start_ns && s.t_ns <= end_ns) result.push_back(s);
  }
  return result;
}

void ImuBuffer::forgetBefore(TimeNs t_ns) {
  while (samples_.size() >= 2 && samples_[1].t_ns <= t_ns) samples_.pop_front();
}

}  // namespace paloc

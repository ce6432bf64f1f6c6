#include "imu_queue.h"

#include <algorithm>

namespace paloc {

void ImuQueue::add(const ImuSample& sample) {
  if (!samples_.empty()) {
    const double dt_s = secondsBetween(newestNs(), sample.t_ns);
    if (dt_s > max_gap_s_) {
      ++gaps_;
      if (dt_s > longest_gap_s_) {
        longest_gap_s_ = dt_s;
        longest_gap_ns_ = newestNs();
      }
    }
  }
  gravity_.add(sample);
  samples_.push_back({sample, gravity_.up().value_or(Vec3::UnitZ())});
}

std::optional<ImuSample> ImuQueue::takeUntil(TimeNs until_ns) {
  if (given_ == samples_.size() || (last_given_ns_ && *last_given_ns_ >= until_ns)) {
    return std::nullopt;
  }
  const ImuSample& sample = samples_[given_++].sample;
  last_given_ns_ = sample.t_ns;
  return sample;
}

std::size_t ImuQueue::lowerBound(TimeNs t_ns) const {
  const auto found =
      std::lower_bound(samples_.begin(), samples_.end(), t_ns,
                       [](const Entry& entry, TimeNs t) { return entry.sample.t_ns < t; });
  return static_cast<std::size_t>(found - samples_.begin());
}

std::vector<ImuSample> ImuQueue::covering(TimeNs start_ns, TimeNs end_ns) const {
  std::size_t first = lowerBound(start_ns + 1);
  const std::size_t last = lowerBound(end_ns);
  if (first == 0 || last == samples_.size()) return {};
  --first;
  std::vector<ImuSample> result;
  for (std::size_t i = first; i <= last; ++i) {
    const ImuSample& sample = samples_[i].sample;
    if (i > first && secondsBetween(result.back().t_ns, sample.t_ns) > max_gap_s_) return {};
    result.push_back(sample);
  }
  return result;
}

std::optional<Vec3> ImuQueue::upAt(TimeNs t_ns) const {
  const std::size_t i = lowerBound(t_ns);
  if (i == samples_.size()) return std::nullopt;
  return samples_[i].up_body;
}

void ImuQueue::forgetBefore(TimeNs t_ns) {
  while (given_ > 1 && samples_[1].sample.t_ns < t_ns) {
    samples_.pop_front();
    --given_;
  }
}

}  // namespace paloc
